#pragma once
/// Distance of the vehicle's surroundings from a few points: the local counterpart of
/// DistanceField.
///
/// A window of nodes around the vehicle. Each point writes its exact distance into the nodes within
/// reach, so that a query costs the same whatever the number of points. Between nodes bilinear:
/// up to h^2 / (4 d) too far at distance d (h = 0.1 m: 0.02 m at 0.15 m, 0.005 m at 0.5 m).

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

namespace vinerow::controllers {

class PointField {
 public:
  static constexpr int kNodes = 96;          ///< per side
  static constexpr double kSpacing_m = 0.1;  ///< h
  static constexpr double kReach_m = 1.3;    ///< larger distances count as infinite

  PointField();

  /// Replaces the points. No heap; about 0.5 us per point.
  void build(const Eigen::Vector2d& centre_W, std::span<const Eigen::Vector2d> points_W);
  bool empty() const { return empty_; }
  /// Distance to the nearest point, m; infinity beyond reach or outside the window.
  double at(const Eigen::Vector2d& p_W) const;

 private:
  bool empty_ = true;
  Eigen::Vector2d corner_W_ = {0, 0};
  std::vector<float> distance_m_;  // x fastest; squared while building
};

}  // namespace vinerow::controllers
