#pragma once
/// Run of the flight curve with rounded bends, as a function of the distance along the plan.
///
/// The curve is averaged along itself over `blend_m` and again over half of it. Straights stay
/// straight, corners become short arcs, and at the start of an arc the curvature rises over blend_m
/// instead of at once: the reference notes that steps of curvature drive the yaw torque into its
/// limit. An arc of radius R moves blend_m^2 (1 + 1/4) / (24 R) inwards (0.8 m at 1.77 m: 19 mm),
/// and half of that where it meets a straight.

#include "controllers/trajectory/flight_curve.h"
#include "controllers/trajectory/uniform_spline.h"

namespace vinerow::controllers {

class SmoothRun {
 public:
  struct Sample {
    Eigen::Vector3d p_W, first, second;  ///< and its derivatives with respect to the distance
    double yaw_rad = 0.0;                ///< direction of travel, continuous along the run
    double yaw_per_m = 0.0;              ///< its derivative with respect to the distance
  };

  /// Allocates. @pre the run has a length
  SmoothRun(const CurveRun& run, double blend_m);

  /// No heap. @param at_m  clamped to the run
  Sample at(double at_m) const;
  double length_m() const { return spline_.length(); }
  bool is_vertical() const { return is_vertical_; }
  double start_yaw_rad() const { return yaw_rad_.front(); }
  double end_yaw_rad() const { return yaw_rad_.back(); }

  /// Knots, and kind and speed of the plan between a knot and the next.
  int knots() const { return static_cast<int>(yaw_rad_.size()); }
  double step_m() const { return spline_.step(); }
  PathKind kind_at(double at_m) const { return kinds_[spline_.piece_at(at_m)]; }
  PathKind kind(int knot) const { return kinds_[knot]; }
  double speed_mps(int knot) const { return speeds_mps_[knot]; }

 private:
  bool is_vertical_;
  UniformSpline<Eigen::Vector3d> spline_;
  std::vector<double> yaw_rad_;  // at the knots, not wrapped
  std::vector<PathKind> kinds_;
  std::vector<double> speeds_mps_;
};

}  // namespace vinerow::controllers
