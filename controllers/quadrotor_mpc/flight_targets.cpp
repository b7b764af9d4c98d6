#include "controllers/quadrotor_mpc/flight_targets.h"

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"

namespace vinerow::controllers {
namespace {

constexpr double kMinLift = 0.3;

}  // namespace

FlightTargets::FlightTargets(const RotorcraftModel& craft, int horizon, double period_s)
    : craft_(craft),
      period_s_(period_s),
      states_(Eigen::MatrixXd::Zero(HoverModel::kStatesWithLag, horizon + 1)),
      inputs_(Eigen::MatrixXd::Zero(HoverModel::kInputs, horizon)) {}

void FlightTargets::update(const HoverFrame& frame, const std::vector<TrajectoryPoint>& preview,
                           const Eigen::Vector3d& acceleration_H, const Eigen::Vector3d& torque_H) {
  const int last = static_cast<int>(states_.cols()) - 1;
  VINEROW_ASSERT(static_cast<int>(preview.size()) == last + 1);
  const double g = craft_.gravity_mps2, drag_per_s = craft_.rotor_drag_Ns_per_m / craft_.mass_kg;
  for (int k = 0; k <= last; ++k) {
    const TrajectoryPoint& at = preview[k];
    auto r = states_.col(k);
    r.segment<3>(kHoverPosition) = frame.from_W(at.p_W - frame.p_WH());
    r.segment<3>(kHoverVelocity) = frame.from_W(at.v_W);
    const Eigen::Vector3d push =
        frame.from_W(at.a_W) + drag_per_s * r.segment<3>(kHoverVelocity) - acceleration_H;
    const double lift = std::max(g + push.z(), kMinLift * g);
    r.segment<3>(kHoverAngle) << -std::atan2(push.y(), lift), std::atan2(push.x(), lift),
        at.yaw_rad - frame.yaw_rad();
    if (k == 0) {
      missed_mps2_ << push.x() - g * r[kHoverAngle + 1], push.y() + g * r[kHoverAngle];
    }
    r[kHoverRate + 2] = at.yaw_rate_radps;
    r[kHoverWrench] = craft_.mass_kg * push.z();
    r.segment<3>(kHoverWrench + 1) = -torque_H;
  }
  // Rates of the tilt: central differences, so a jump of the curvature takes two ticks.
  for (int k = 0; k <= last; ++k) {
    const int before = std::max(k - 1, 0), after = std::min(k + 1, last);
    states_.block<2, 1>(kHoverRate, k) =
        (states_.block<2, 1>(kHoverAngle, after) - states_.block<2, 1>(kHoverAngle, before)) /
        (period_s_ * (after - before));
  }
  inputs_ = states_.bottomLeftCorner(HoverModel::kInputs, last);
}

void FlightTargets::lead_back(double excess_m) {
  constexpr double kTime_s = 1.0;
  const double keep = std::exp(-period_s_ / kTime_s);
  double offset_m = excess_m;
  for (int k = 0; k < states_.cols(); ++k, offset_m *= keep) {
    states_(kHoverPosition, k) += offset_m;
    states_(kHoverVelocity, k) -= offset_m / kTime_s;
  }
}

}  // namespace vinerow::controllers
