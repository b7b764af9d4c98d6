#pragma once
/// The part of the ground that a cloud covers.

#include <Eigen/Geometry>

#include "engine/math/polygon.h"

namespace vinerow::mapping {

/// A polygon and all that is at most `margin_m` outside of it.
class SurveyArea {
 public:
  /// @throws ConfigError: fewer than three corners, a corner that is not finite, a polygon that
  /// crosses itself or has no area, a margin that is negative or not finite
  SurveyArea(Polygon polygon_W, double margin_m);

  bool contains(const Eigen::Vector2d& p_W) const { return contains(p_W, 0.0); }
  /// With so much more margin.
  bool contains(const Eigen::Vector2d& p_W, double further_m) const;
  /// Axis-aligned, around it.
  Eigen::AlignedBox2d box_W() const;

 private:
  Polygon polygon_;
  double margin_m_;
};

}  // namespace vinerow::mapping
