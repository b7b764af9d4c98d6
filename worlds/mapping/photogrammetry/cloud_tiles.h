#pragma once
/// Division of an area into square tiles of square cells, and parallel work on tiles with points in
/// the order of the tiles.

#include <cstdint>
#include <functional>
#include <vector>

#include "worlds/mapping/photogrammetry/cloud_extent.h"
#include "worlds/mapping/photogrammetry/sampled_point.h"

namespace vinerow::mapping {

class CloudTiles {
 public:
  /// One cell for each point of the density. A tile has up to 128 x 128 cells and is at most 6 m
  /// wide.
  /// @param further_m  extension beyond the area
  /// @throws ConfigError: the density is not above zero and at most 1e6 per square metre
  CloudTiles(const SurveyArea& area, double further_m, double density_per_m2);

  std::int64_t count() const { return columns_ * rows_; }
  double cell_m() const { return cell_m_; }
  /// Cells along one side.
  int side() const { return side_; }
  double width_m() const { return side_ * cell_m_; }
  Eigen::Vector2d corner_W(std::int64_t tile) const {
    return corner_W_ + width_m() * Eigen::Vector2d(static_cast<double>(tile % columns_),
                                                   static_cast<double>(tile / columns_));
  }
  Eigen::Vector2d middle_W(std::int64_t tile) const {
    return corner_W(tile) + 0.5 * Eigen::Vector2d(width_m(), width_m());
  }

 private:
  Eigen::Vector2d corner_W_;
  double cell_m_;
  int side_;
  std::int64_t columns_, rows_;
};

/// Calls make(k, points) for k = 0 to count - 1 on all cores, then sink(points) and done(k) in the
/// order of k. Points of a few dozen k are in memory at once.
/// @param make  appends to `points`, which is empty; thread safe
void stream_points(
    std::int64_t count,
    const std::function<void(std::int64_t k, std::vector<SampledPoint>& points)>& make,
    const std::function<void(std::int64_t k)>& done, const CloudSink& sink);

}  // namespace vinerow::mapping
