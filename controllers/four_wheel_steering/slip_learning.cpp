#include "controllers/four_wheel_steering/slip_learning.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {
namespace {
constexpr double kCrawl_mps = 0.2;  // below, directions of the velocity are noise
constexpr double kLargestSlip_rad = 0.35;
constexpr double kLargestCurvature_per_m = 0.2;
}  // namespace

void SlipLearning::update(const Rolling& rolling, const Eigen::Vector2d& v_B, double yaw_rate_radps,
                          double dt_s) {
  if (learn_s_ <= 0.0 || std::abs(v_B.x()) < kCrawl_mps) return;
  const double share = 1.0 - std::exp(-dt_s / learn_s_);
  // Estimators that do not measure the lateral velocity output exactly zero.
  if (v_B.y() != 0.0) {
    const double slip = std::atan(v_B.y() / v_B.x()) - rolling.side_slip_rad();
    slip_rad_ += share * (slip - slip_rad_);
    slip_rad_ = std::clamp(slip_rad_, -kLargestSlip_rad, kLargestSlip_rad);
  }
  const double speed_mps = std::copysign(v_B.norm(), v_B.x());
  const double curvature = yaw_rate_radps / speed_mps - rolling.track_curvature_per_m();
  curvature_per_m_ += share * (curvature - curvature_per_m_);
  curvature_per_m_ =
      std::clamp(curvature_per_m_, -kLargestCurvature_per_m, kLargestCurvature_per_m);
}

}  // namespace vinerow::controllers
