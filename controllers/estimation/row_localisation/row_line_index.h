#pragma once
/// The rows of a map that are nearest to a point, seen from above.
///
/// The pieces of the rows' lines lie in a tree of boxes (a bounding volume hierarchy over east and
/// north, each box cut at the median of its longer side), so that only what lies near is looked at.

#include <cstdint>
#include <vector>

#include "controllers/estimation/row_localisation/row_line.h"
#include "engine/api/forward.h"

namespace vinerow::controllers {

class RowLineIndex {
 public:
  struct NearestRows {
    LinePoint first, second;  ///< of two rows; +infinity away where there is none
  };

  /// Copies the lines.
  explicit RowLineIndex(const RowMap& map);

  /// What nearest_on() tells of the two nearest of all rows, to the bit; of equals those that the
  /// map lists first. No heap, thread safe.
  NearestRows nearest_rows(const Eigen::Vector3d& p_W) const;

 private:
  struct Piece {
    Eigen::Vector3d from_W, to_W;
    std::uint32_t row, number;  // in the map's order
  };
  struct Box {
    Eigen::Vector2d low_W, high_W;
    std::uint32_t begin, end;  // pieces
    std::uint32_t second = 0;  // box of the second half, the first one's is the next; 0: a leaf
  };
  struct Search;

  void lay_boxes(std::uint32_t begin, std::uint32_t end);

  std::vector<Piece> pieces_;
  std::vector<Box> boxes_;
  double largest_m_ = 0.0;  // coordinate
};

}  // namespace vinerow::controllers
