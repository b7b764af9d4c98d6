#pragma once
/// A few of very many points, spread evenly over a file, and what they tell of the whole.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "engine/core/random.h"

namespace vinerow::mapping {

/// Keeps one point of each window of 1, 2, 4, ... points in their order: the windows double when
/// there are more than kMost. Which one of a window is random, so that a raster's columns are
/// sampled alike, and the same in every run. Up to kMost points, it keeps all.
class CloudSample {
 public:
  static constexpr std::size_t kMost = 1 << 16;

  CloudSample();
  void add(const Eigen::Vector3d& point) {
    if (count_++ == next_) keep(point);
  }
  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  std::uint64_t window() const { return window_; }  ///< points that each of them stands for

 private:
  void keep(const Eigen::Vector3d& point);

  std::vector<Eigen::Vector3d> points_;
  RandomStream random_;
  std::uint64_t count_ = 0, next_ = 0, window_ = 1, windows_ = 0;
};

/// The box of most of the points: `trim` of them (a share, below 0.5) may lie beyond each side of
/// each axis. @param points  at least one
Eigen::AlignedBox3d bulk_of(const std::vector<Eigen::Vector3d>& points, double trim);

/// Horizontal length and width of points along their principal axes, without the outer 0.5 % of
/// each side.
struct Footprint {
  double length_m = 0.0, width_m = 0.0;
};
Footprint footprint_of(const std::vector<Eigen::Vector3d>& points_m);

/// The most points that lie in one square centimetre of the ground, of a grid.
std::size_t densest_square_centimetre(const std::vector<Eigen::Vector3d>& points_m);

}  // namespace vinerow::mapping
