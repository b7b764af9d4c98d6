#include "engine/physics/height_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/height_field.h"

namespace vinerow::physics {
namespace {

HeightRanges::Range rounded_outwards(double h_m) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto near_m = static_cast<float>(h_m);
  return {near_m > h_m ? std::nextafter(near_m, -kInfinity) : near_m,
          near_m < h_m ? std::nextafter(near_m, kInfinity) : near_m};
}

}  // namespace

HeightRanges::HeightRanges(const HeightField& field, const Eigen::Vector2d& tilt_m) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Level finest;
  finest.columns = (field.columns - 2) / kCells + 1;
  finest.rows = (field.rows - 2) / kCells + 1;
  finest.ranges.reserve(static_cast<std::size_t>(finest.columns) *
                        static_cast<std::size_t>(finest.rows));
  for (int sj = 0; sj < finest.rows; ++sj) {
    for (int si = 0; si < finest.columns; ++si) {
      Range range{kInfinity, -kInfinity};
      // With the samples on both edges, which neighbours share.
      const int last_j = std::min((sj + 1) * kCells, field.rows - 1);
      const int last_i = std::min((si + 1) * kCells, field.columns - 1);
      for (int j = sj * kCells; j <= last_j; ++j) {
        for (int i = si * kCells; i <= last_i; ++i) {
          const double h_m =
              field
                  .heights_m[static_cast<std::size_t>(j) * static_cast<std::size_t>(field.columns) +
                             static_cast<std::size_t>(i)] -
              (i * tilt_m.x() + j * tilt_m.y());
          extend(range, rounded_outwards(h_m));
        }
      }
      finest.ranges.push_back(range);
    }
  }
  levels_.push_back(std::move(finest));

  while (levels_.back().ranges.size() > 1) {
    const Level& fine = levels_.back();
    Level coarse;
    coarse.columns = (fine.columns + 1) / 2;
    coarse.rows = (fine.rows + 1) / 2;
    coarse.ranges.assign(
        static_cast<std::size_t>(coarse.columns) * static_cast<std::size_t>(coarse.rows),
        {kInfinity, -kInfinity});
    for (int j = 0; j < fine.rows; ++j) {
      for (int i = 0; i < fine.columns; ++i) {
        extend(
            coarse
                .ranges[static_cast<std::size_t>(j / 2) * static_cast<std::size_t>(coarse.columns) +
                        static_cast<std::size_t>(i / 2)],
            fine.at(i, j));
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

}  // namespace vinerow::physics
