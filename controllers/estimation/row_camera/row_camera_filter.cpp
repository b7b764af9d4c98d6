#include "controllers/estimation/row_camera/row_camera_filter.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

using Eigen::Vector2d;

const ParameterTable<RowCameraFilterParams>& row_camera_filter_table() {
  using P = RowCameraFilterParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("start_std_m", "m", &P::start_std_m, between(0.0, 10.0),
                  "1 sigma of the place at the start, on each axis")
          .degrees("start_yaw_std_deg", &P::start_yaw_std_rad, between(0.0, 30.0),
                   "1 sigma of the heading at the start")
          .number("start_bias_std_radps", "rad/s", &P::start_bias_std_radps, between(0.0, 1.0),
                  "1 sigma of the gyro's bias at the start")
          .number("drift_m_per_sqrt_m", "m/sqrt(m)", &P::drift_m_per_sqrt_m, kPositive,
                  "1 sigma of the error of dead reckoning over one metre")
          .number("slip_m_per_sqrt_rad", "m/sqrt(rad)", &P::slip_m_per_sqrt_rad, kNotNegative,
                  "1 sigma of the error of dead reckoning over a turn by one radian")
          .number("turn_rad_per_sqrt_s", "rad/sqrt(s)", &P::turn_rad_per_sqrt_s, kPositive,
                  "1 sigma of the heading's error over one second")
          .number("bias_radps_per_sqrt_s", "rad/s/sqrt(s)", &P::bias_radps_per_sqrt_s, kNotNegative,
                  "1 sigma of the bias's change over one second")
          .number("mark_std_m", "m", &P::mark_std_m, kPositive,
                  "1 sigma of a mark's distance from the row's line")
          .number("mark_gate_m", "m", &P::mark_gate_m, kPositive,
                  "marks that are farther from where they are expected are not used")
          .number("marks_per_picture", "", &P::marks_per_picture, between(1.0, 1e4),
                  "marks of a picture count as at most so many independent ones");
  return table;
}

RowCameraFilter::RowCameraFilter(const RowCameraFilterParams& params, std::vector<Polyline> rows)
    : params_(params), rows_(std::move(rows)) {}

void RowCameraFilter::start(const Eigen::Vector3d& start) {
  x_ << start, 0.0;
  const double m2 = params_.start_std_m * params_.start_std_m;
  P_.setZero();
  P_.diagonal() << m2, m2, params_.start_yaw_std_rad * params_.start_yaw_std_rad,
      params_.start_bias_std_radps * params_.start_bias_std_radps;
  ready_ = true;
}

void RowCameraFilter::predict(double speed_mps, double rate_radps, double period_s) {
  const double turn = (rate_radps - x_[3]) * period_s, way_m = speed_mps * period_s;
  // The chord of an arc has the mean heading.
  const double heading = x_[2] + 0.5 * turn;
  const Vector2d along(std::cos(heading), std::sin(heading)), left(-along.y(), along.x());
  x_.head<2>() += way_m * along;
  x_[2] = wrap_angle(x_[2] + turn);
  Eigen::Matrix4d F = Eigen::Matrix4d::Identity();
  F.block<2, 1>(0, 2) = way_m * left;
  F.block<2, 1>(0, 3) = -0.5 * period_s * way_m * left;
  F(2, 3) = -period_s;
  const Eigen::Matrix4d before = P_;
  P_.noalias() = F * before.lazyProduct(F.transpose());
  const double q = params_.drift_m_per_sqrt_m, slip = params_.slip_m_per_sqrt_rad;
  const double q2 = q * q * std::abs(way_m) + slip * slip * std::abs(turn);
  const double t = params_.turn_rad_per_sqrt_s, b = params_.bias_radps_per_sqrt_s;
  P_.diagonal() += Eigen::Vector4d(q2, q2, t * t * period_s, b * b * period_s);
}

int RowCameraFilter::correct(const std::vector<RowMark>& marks, const State& past) {
  const double c = std::cos(past[2]), s = std::sin(past[2]);
  // Sums of the normal equations.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  int used = 0;
  for (const RowMark& mark : marks) {
    const Vector2d turned(c * mark.p_B.x() - s * mark.p_B.y(), s * mark.p_B.x() + c * mark.p_B.y());
    const Vector2d p = past.head<2>() + turned;
    const PolylineIndex::Nearest nearest = rows_.nearest(p);
    if (nearest.line < 0) continue;
    const Polyline& line = rows_.lines()[static_cast<std::size_t>(nearest.line)];
    // Beyond a row's end there is no line.
    if (line.is_end(nearest)) continue;
    const auto& points = line.points();
    const auto at = static_cast<std::size_t>(nearest.segment);
    const Vector2d along = (points[at + 1] - points[at]).normalized();
    const Vector2d n(-along.y(), along.x());
    const double residual = -n.dot(p - nearest.point);
    if (std::abs(residual) > params_.mark_gate_m) continue;
    const Eigen::Vector3d h(n.x(), n.y(), n.dot(Vector2d(-turned.y(), turned.x())));
    // Huber's weight: beyond one and a half sigma an error counts by its size alone.
    const Vector2d& s_B = mark.range_std_B;
    const double range_m = n.dot(Vector2d(c * s_B.x() - s * s_B.y(), s * s_B.x() + c * s_B.y()));
    const double std_m = std::hypot(params_.mark_std_m, range_m);
    const double bend_m = 1.5 * std_m;
    const double weight =
        std::min(1.0, bend_m / std::max(std::abs(residual), 1e-9)) / (std_m * std_m);
    information += weight * h * h.transpose();
    pull += weight * residual * h;
    ++used;
  }
  if (used == 0) return 0;
  const double scale = std::min(1.0, params_.marks_per_picture / used);
  // Information form: P+ = (P^-1 + I)^-1, without inverting P, which may be singular at the start:
  // P+ = (1 + P I)^-1 P.
  Eigen::Matrix4d all = Eigen::Matrix4d::Zero();
  all.topLeftCorner<3, 3>() = scale * information;
  const Eigen::Matrix4d before = P_;
  P_ = (Eigen::Matrix4d::Identity() + before * all).lu().solve(before);
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  Eigen::Vector4d wanted = Eigen::Vector4d::Zero();
  wanted.head<3>() = scale * pull;
  x_ += P_ * wanted;
  x_[2] = wrap_angle(x_[2]);
  return used;
}

}  // namespace vinerow::controllers
