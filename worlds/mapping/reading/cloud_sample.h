#pragma once
/// Sample of points, spread evenly over a file, and statistics from it.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "engine/core/random.h"

namespace vinerow::mapping {

/// Keeps one point of each window of 1, 2, 4, ... points in their order; the windows double when
/// there are more than kMax. The choice within a window is random, so that the columns of a raster
/// are sampled equally, and the same in every run. Up to kMax points are all kept.
class CloudSample {
 public:
  static constexpr std::size_t kMax = 1 << 16;

  CloudSample();
  void add(const Eigen::Vector3d& point) {
    if (count_++ == next_) keep(point);
  }
  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  std::uint64_t window() const { return window_; }  ///< points represented by each of them

 private:
  void keep(const Eigen::Vector3d& point);

  std::vector<Eigen::Vector3d> points_;
  RandomStream random_;
  std::uint64_t count_ = 0, next_ = 0, window_ = 1, windows_ = 0;
};

/// Box of most of the points: a share `trim` (below 0.5) of them may be beyond each side of each
/// axis. @param points  at least one
Eigen::AlignedBox3d bulk_of(const std::vector<Eigen::Vector3d>& points, double trim);

/// Horizontal length and width of points along their principal axes, without the outer 0.5 % of
/// each side.
struct Footprint {
  double length_m = 0.0, width_m = 0.0;
};
Footprint footprint_of(const std::vector<Eigen::Vector3d>& points_m);

/// Largest number of points in one cell of a grid of 1 cm2 on the ground.
std::size_t densest_square_centimetre(const std::vector<Eigen::Vector3d>& points_m);

}  // namespace vinerow::mapping
