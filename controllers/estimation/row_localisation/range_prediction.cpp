#include "controllers/estimation/row_localisation/range_prediction.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {

double RangePrediction::gradient_yaw(const Eigen::Vector3d& p_WB) const {
  // The rotation moves the point of the echo about the body; the facet does not move.
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
    reach_m = hit->distance_m;  // farther hits do not count
    first = RangePrediction{hit->distance_m, origin_W, dir_W, *hit};
  };
  look(ahead_W);
  const int side_rays = sensor.half_angle_rad > 0.0 ? (sensor.fan_rays - 1) / 2 : 0;
  if (side_rays == 0) return first;
  // Cosine and sine of k steps from the addition theorem, one step at a time.
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

SpreadPrediction predict_spread(const RowMeshIndex& map, const Pose& X_WB,
                                const RangeSensorModel& sensor, double max_range_m,
                                const RangePrediction& middle, const Eigen::Vector3d& along_W,
                                double std_m, double max_along, bool stands) {
  constexpr double kMinSpread_m = 1e-4;  // below it the tangent is exact enough
  constexpr double kNear_m = 0.15;       // below it the same ray of the fan returns first
  const SpreadPrediction tangent{middle.range_m, middle.gradient_p().dot(along_W), 0.0};
  if (!(std_m > kMinSpread_m)) return tangent;
  const auto look_from = [&](double along_m) -> std::optional<RowMeshIndex::Hit> {
    if (std_m < kNear_m) {
      return map.cast_ray(middle.origin_W + along_m * along_W, middle.dir_W, max_range_m);
    }
    const auto first =
        predict_range(map, {X_WB.q, X_WB.p + along_m * along_W}, sensor, max_range_m);
    return first ? std::optional(first->hit) : std::nullopt;
  };
  // Weighted moments of the distance x along the line and the range y relative to the middle.
  double weights = 1.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  bool is_whole = true;
  for (const int sigmas : {-2, -1, 1, 2}) {
    const double along_m = sigmas * std_m;
    const auto there = look_from(along_m);
    if (!there || there->row != middle.hit.row ||
        std::abs(there->normal_W.head<2>().dot(along_W.head<2>().normalized())) > max_along) {
      is_whole = false;
      continue;
    }
    const double weight = std::exp(-0.5 * sigmas * sigmas);
    const double off_m = there->distance_m - middle.range_m;
    weights += weight;
    x += weight * along_m;
    y += weight * off_m;
    xx += weight * along_m * along_m;
    xy += weight * along_m * off_m;
    yy += weight * off_m * off_m;
  }
  x /= weights;
  y /= weights;
  xx /= weights;
  xy /= weights;
  yy /= weights;
  const double spread_m2 = xx - x * x;
  if (!(spread_m2 > 0.0)) return tangent;  // only the middle is usable
  const double fitted = (xy - x * y) / spread_m2;
  if (is_whole && !stands) {
    const double variance_m2 = yy - y * y - fitted * fitted * spread_m2;
    return {middle.range_m + y - fitted * x, fitted, std::max(0.0, variance_m2)};
  }
  double slope = 0.0;
  if (fitted * tangent.slope > 0.0) {
    slope = std::abs(fitted) < std::abs(tangent.slope) ? fitted : tangent.slope;
  }
  // Variance about the line through the middle.
  const double variance_m2 = yy - 2.0 * slope * xy + slope * slope * xx;
  return {middle.range_m, slope, std::max(0.0, variance_m2)};
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

}  // namespace vinerow::controllers
