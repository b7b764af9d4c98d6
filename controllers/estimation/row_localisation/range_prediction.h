#pragma once
/// Predicted reading of a range sensor at a pose on the map, with gradient and variance. Source:
/// docs/papers/localisation.md; paper C, section 3, except that the slab of an echo comes from the
/// facet's plane N.x = D instead of its eq. 10-12.

#include <optional>
#include <string>

#include "controllers/estimation/row_localisation/row_mesh_index.h"
#include "engine/math/pose.h"

namespace vinerow::controllers {

/// Model of a range sensor in an estimator.
struct RangeSensorModel {
  std::string name;             ///< of its signal
  Pose X_BS;                    ///< the sensor looks along x of S
  double half_angle_rad = 0.0;  ///< of its cone; 0: a single ray
  int fan_rays = 1;  ///< rays over the cone from edge to edge in the plane z = 0 of S, odd; the
                     ///< first return counts
  double bound_m = 0.003;  ///< largest error of a reading
};

/// The predicted first return.
struct RangePrediction {
  double range_m = 0.0;                                ///< h
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();  ///< of the ray: the sensor
  Eigen::Vector3d dir_W = Eigen::Vector3d::UnitX();    ///< u, unit
  RowMeshIndex::Hit hit;                               ///< facet N.x = D; N.u < 0

  /// N.u, < 0.
  double slope() const { return hit.normal_W.dot(dir_W); }
  /// dh/dp, p the body's origin in W: -N' / (N.u).
  Eigen::Vector3d gradient_p() const { return -hit.normal_W / slope(); }
  /// dh/dpsi for a rotation of the body about the vertical through its origin at p_WB.
  double gradient_yaw(const Eigen::Vector3d& p_WB) const;
};

/// @returns nullopt if no ray of the fan hits the map within max_range_m
std::optional<RangePrediction> predict_range(const RowMeshIndex& map, const Pose& X_WB,
                                             const RangeSensorModel& sensor, double max_range_m);

/// Regression line of the range over positions spread along a line. A row's wall is too rough for
/// its tangent at one point to hold over the spread (statistical linear regression: Lefebvre,
/// Bruyninckx, De Schutter, IEEE Trans. Autom. Control 47(8) 1406, 2002).
struct SpreadPrediction {
  double range_m = 0.0;      ///< of the fitted line at the middle of the spread
  double slope = 0.0;        ///< d range / d distance along the line
  double variance_m2 = 0.0;  ///< of the ranges about the fitted line
};

/// Fits the line over five positions up to 2 sigma away; for a small spread along the ray of the
/// middle position. The slope is the smaller of those of the fit and the tangent, 0 if their signs
/// differ, in two cases: only some positions are usable (the others see another row, no row, or the
/// end face of a run of plants), or all readings come from one position.
/// @param middle  the prediction at X_WB @param along_W  unit  @param std_m of the spread
/// @param max_along  limit of |normal . along|; beyond it a facet is the end face of a run of
/// plants
/// @param stands  whether the vehicle is stationary: then all readings are of the same points
SpreadPrediction predict_spread(const RowMeshIndex& map, const Pose& X_WB,
                                const RangeSensorModel& sensor, double max_range_m,
                                const RangePrediction& middle, const Eigen::Vector3d& along_W,
                                double std_m, double max_along, bool stands);

constexpr double kMaxCorrelationInflation = 1e6;

/// Factor on the variance of a map error for readings that follow each other faster than the error
/// changes along the row: max(1, 2.5 l / (v T)).
/// @param correlation_length_m  l  @param speed_mps  v  @param period_s  T between readings
/// @returns at most kMaxCorrelationInflation, the value for a stationary vehicle, whose readings
/// all have the same map error
double correlation_inflation(double correlation_length_m, double speed_mps, double period_s);

/// Variance of reading minus h, m2: r sigma_m^2 / (N.u)^2 + bound^2 / 3 + (dh/dpsi sigma_psi)^2.
double range_variance(const RangePrediction& prediction, const Eigen::Vector3d& p_WB,
                      double surface_std_m, double inflation, double bound_m, double yaw_std_rad);

}  // namespace vinerow::controllers
