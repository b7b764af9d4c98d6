#pragma once
/// Area of the ground that a cloud covers.

#include <Eigen/Geometry>

#include "engine/math/polygon.h"

namespace vinerow::mapping {

/// Polygon and everything within `margin_m` of it.
class SurveyArea {
 public:
  /// @throws ConfigError: fewer than three corners, a corner that is not finite, a polygon that
  /// crosses itself or has no area, a margin that is negative or not finite
  SurveyArea(Polygon polygon_W, double margin_m);

  bool contains(const Eigen::Vector2d& p_W) const { return contains(p_W, 0.0); }
  /// The same area with a larger margin.
  bool contains(const Eigen::Vector2d& p_W, double further_m) const;
  /// Radius of a circle around a point that lies inside as a whole; 0 if the point does not.
  double inside_m(const Eigen::Vector2d& p_W) const;
  /// Axis-aligned bounding box.
  Eigen::AlignedBox2d box_W() const;

 private:
  Polygon polygon_;
  double margin_m_;
};

}  // namespace vinerow::mapping
