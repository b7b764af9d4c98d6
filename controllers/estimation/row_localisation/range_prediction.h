#pragma once
/// What a range sensor should read at a pose on the map, how that depends on the pose, and how well
/// it is known. Source: ../../docs/papers/localisation.md; paper C, section 3, with the slab of an echo
/// taken from the facet's plane N.x = D in place of its eq. 10-12.

#include <optional>
#include <string>

#include "controllers/estimation/row_localisation/row_mesh_index.h"
#include "engine/math/pose.h"

namespace vinerow::controllers {

/// A range sensor as an estimator knows it.
struct RangeSensorModel {
  std::string name;             ///< of its signal
  Pose X_BS;                    ///< it looks along x of S
  double half_angle_rad = 0.0;  ///< of its cone; 0: a single ray
  int fan_rays = 1;  ///< rays over the cone from edge to edge in the plane z = 0 of S, odd; the
                     ///< first return counts
  double bound_m = 0.003;  ///< largest error of a reading
};

/// The first return.
struct RangePrediction {
  double range_m = 0.0;                                ///< h
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();  ///< of the ray: the sensor
  Eigen::Vector3d dir_W = Eigen::Vector3d::UnitX();    ///< u, unit
  RowMeshIndex::Hit hit;                               ///< facet N.x = D; N.u < 0

  /// N.u, < 0.
  double slope() const { return hit.normal_W.dot(dir_W); }  ///< N.u
  /// dh/dp, p the body's origin in W: -N' / (N.u).
  Eigen::Vector3d gradient_p() const { return -hit.normal_W / slope(); }
  /// dh/dpsi of a turn of the body about the vertical through its origin at p_WB.
  double gradient_yaw(const Eigen::Vector3d& p_WB) const;
};

/// @returns nothing where no ray of the fan meets the map within max_range_m
std::optional<RangePrediction> predict_range(const RowMeshIndex& map, const Pose& X_WB,
                                             const RangeSensorModel& sensor, double max_range_m);

/// A range over places spread along a line, as the straight line that fits it best: a row's wall is
/// too rough for its tangent at one place to hold over the spread (statistical linear regression:
/// Lefebvre, Bruyninckx, De Schutter, IEEE Trans. Autom. Control 47(8) 1406, 2002).
struct SpreadPrediction {
  double range_m = 0.0;      ///< of the fitted line at the middle of the spread
  double slope = 0.0;        ///< d range / d way along the line
  double variance_m2 = 0.0;  ///< of the ranges about the fitted line
};

/// Fitted over five places up to 2 sigma away, of a small spread along the middle's own ray. Where
/// only some of them tell - others see another row, none, or what closes a run of plants - or where
/// all readings come from one place, the slope is the smaller one of the fit's and the tangent's, 0
/// where they disagree about its sign.
/// @param middle  what is predicted at X_WB  @param along_W  unit  @param std_m
/// of the spread
/// @param most_along  |normal . along| of facets that close a run of plants
/// @param stands  the vehicle stands: its readings tell of the same places
SpreadPrediction predict_spread(const RowMeshIndex& map, const Pose& X_WB,
                                const RangeSensorModel& sensor, double max_range_m,
                                const RangePrediction& middle, const Eigen::Vector3d& along_W,
                                double std_m, double most_along, bool stands);

constexpr double kMaxCorrelationInflation = 1e6;

/// By how much the variance of a map error must be enlarged where readings follow each other faster
/// than the error changes along the row: max(1, 2.5 l / (v T)).
/// @param correlation_length_m  l  @param speed_mps  v  @param period_s  T between readings
/// @returns at most kMaxCorrelationInflation, which a standing vehicle gets: its readings all have
/// one and the same map error
double correlation_inflation(double correlation_length_m, double speed_mps, double period_s);

/// Variance of reading minus h, m2: r sigma_m^2 / (N.u)^2 + bound^2 / 3 + (dh/dpsi sigma_psi)^2.
double range_variance(const RangePrediction& prediction, const Eigen::Vector3d& p_WB,
                      double surface_std_m, double inflation, double bound_m, double yaw_std_rad);

}  // namespace vinerow::controllers
