#pragma once
/// Lowest and highest sample of rectangles of a height field, above a plane if one is given: on a
/// slope they differ less above the plane of the slope.
///
/// A pyramid of squares of 4, 8, 16 ... cells: each level halves the number of squares along an
/// axis. The range of a rectangle is that of at most 2 x 2 squares of one level, hence a bound that
/// may be wider than the truth, in constant time.

#include <Eigen/Core>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::physics {

class HeightRanges {
 public:
  /// @param tilt_m  rise of the plane per cell along x and y; it contains the height 0 at sample
  /// (0, 0)
  explicit HeightRanges(const HeightField& field,
                        const Eigen::Vector2d& tilt_m = Eigen::Vector2d::Zero());

  struct Range {
    float low_m, high_m;
  };
  /// Of the whole field.
  const Range& all() const { return levels_.back().ranges.front(); }

  /// Cells along a side of a square of level 0.
  static constexpr int kCells = 4;
  /// @param i0,j0,i1,j1  first and last square of level 0, in the grid, i0 <= i1, j0 <= j1
  Range of(int i0, int j0, int i1, int j1) const {
    std::size_t level = 0;
    while (i1 - i0 > 1 || j1 - j0 > 1) {
      ++level;
      i0 >>= 1, j0 >>= 1, i1 >>= 1, j1 >>= 1;
    }
    const Level& squares = levels_[level];
    Range range = squares.at(i0, j0);
    if (i1 != i0) extend(range, squares.at(i1, j0));
    if (j1 != j0) extend(range, squares.at(i0, j1));
    if (i1 != i0 && j1 != j0) extend(range, squares.at(i1, j1));
    return range;
  }

  int columns() const { return levels_.front().columns; }
  int rows() const { return levels_.front().rows; }
  /// Of a square of 2^level * kCells cells. @pre the level exists, or is above the last
  Range square(int level, int i, int j) const {
    const auto last = static_cast<int>(levels_.size()) - 1;
    return level > last ? all() : levels_[static_cast<std::size_t>(level)].at(i, j);
  }

 private:
  struct Level {
    int columns, rows;
    std::vector<Range> ranges;  ///< x fastest
    const Range& at(int i, int j) const {
      return ranges[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(i)];
    }
  };
  static void extend(Range& range, const Range& other) {
    range.low_m = other.low_m < range.low_m ? other.low_m : range.low_m;
    range.high_m = other.high_m > range.high_m ? other.high_m : range.high_m;
  }

  std::vector<Level> levels_;  ///< the last one has a single square
};

}  // namespace vinerow::physics
