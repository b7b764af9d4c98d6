#include "controllers/estimation/range_prediction.h"

#include <algorithm>
#include <cmath>

namespace vinerow {

double RangePrediction::gradient_yaw(const Eigen::Vector3d& p_WB) const {
  // The turn carries the point of the echo about the body; the facet stays.
  const Eigen::Vector3d lever_W = origin_W + range_m * dir_W - p_WB;
  return -hit.normal_W.dot(Eigen::Vector3d::UnitZ().cross(lever_W)) / slope();
}

std::optional<RangePrediction> predict_range(const RowMeshIndex& map, const Pose& X_WB,
                                             const RangeSensorModel& sensor, double max_range_m) {
  const Eigen::Vector3d origin_W = X_WB * sensor.X_BS.p;
  const Eigen::Quaterniond q_WS = X_WB.q * sensor.X_BS.q;
  const Eigen::Vector3d ahead_W = q_WS * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d left_W = q_WS * Eigen::Vector3d::UnitY();

  std::optional<RangePrediction> first;
  double reach_m = max_range_m;
  const auto look = [&](const Eigen::Vector3d& dir_W) {
    const auto hit = map.cast_ray(origin_W, dir_W, reach_m);
    if (!hit) return;
    reach_m = hit->distance_m;  // what is farther does not count
    first = RangePrediction{hit->distance_m, origin_W, dir_W, *hit};
  };
  look(ahead_W);
  const int side_rays = sensor.half_angle_rad > 0.0 ? (sensor.fan_rays - 1) / 2 : 0;
  if (side_rays == 0) return first;
  // Cosine and sine of k steps by adding one step at a time.
  const double step_rad = sensor.half_angle_rad / side_rays;
  const double c = std::cos(step_rad), s = std::sin(step_rad);
  double along = 1.0, across = 0.0;
  for (int k = 1; k <= side_rays; ++k) {
    const double along_before = along;
    along = c * along - s * across;
    across = s * along_before + c * across;
    look(along * ahead_W + across * left_W);
    look(along * ahead_W - across * left_W);
  }
  return first;
}

double correlation_inflation(double correlation_length_m, double speed_mps, double period_s) {
  const double step_m = std::abs(speed_mps) * period_s;
  const double wanted_m = 2.5 * correlation_length_m;
  if (!(wanted_m > step_m)) return 1.0;
  return wanted_m < kMaxCorrelationInflation * step_m ? wanted_m / step_m
                                                      : kMaxCorrelationInflation;
}

double range_variance(const RangePrediction& prediction, const Eigen::Vector3d& p_WB,
                      double surface_std_m, double inflation, double bound_m, double yaw_std_rad) {
  const double along_ray_m = surface_std_m / prediction.slope();
  const double turn_m = prediction.gradient_yaw(p_WB) * yaw_std_rad;
  return inflation * along_ray_m * along_ray_m + bound_m * bound_m / 3.0 + turn_m * turn_m;
}

}  // namespace vinerow
