#pragma once
/// Index of the rows of a map that finds the two nearest to a point, seen from above.
///
/// The segments of the rows' lines are in a bounding volume hierarchy over east and north; each box
/// is split at the median of its longer side. A query visits only nearby boxes.

#include <cstdint>
#include <vector>

#include "controllers/estimation/row_localisation/row_line.h"
#include "engine/api/forward.h"

namespace vinerow::controllers {

class RowLineIndex {
 public:
  struct NearestRows {
    LinePoint first, second;  ///< of two different rows; distance +infinity if there is no such row
  };

  /// Copies the lines.
  explicit RowLineIndex(const RowMap& map);

  /// The two nearest rows: equal to the bit to nearest_on() over all rows. Among equals, the rows
  /// that the map lists first. No heap, thread safe.
  NearestRows nearest_rows(const Eigen::Vector3d& p_W) const;

 private:
  struct Piece {
    Eigen::Vector3d from_W, to_W;
    std::uint32_t row, number;  // in the map's order
  };
  struct Box {
    Eigen::Vector2d low_W, high_W;
    std::uint32_t begin, end;  // pieces
    std::uint32_t second =
        0;  // box of the second half (that of the first half is the next box); 0: a leaf
  };
  struct Search;

  void lay_boxes(std::uint32_t begin, std::uint32_t end);

  std::vector<Piece> pieces_;
  std::vector<Box> boxes_;
  double largest_m_ = 0.0;  // coordinate
};

}  // namespace vinerow::controllers
