#pragma once
/// Grouping of rows into blocks: rows side by side, in one direction.

#include <vector>

#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

/// Rows of a block, in the order and direction of order_block().
struct RowBlock {
  std::vector<RowCurve> rows;
  double spacing_m = 0.0;  ///< approximate, between neighbours

  double length_m() const;  ///< of all rows
};

struct RowBlocks {
  std::vector<RowBlock> blocks;  ///< by falling total length of rows
  std::vector<RowCurve> lone;    ///< lines without a neighbour
};

/// Groups lines. Two rows belong to one block if they are side by side along a quarter of the
/// shorter one, within 6 degrees and at 0.5 to 2.6 times the spacing (one row between them may be
/// missing). A track across all rows, a wider one along them, or another direction ends a block.
/// Pieces in one line of one block are one row with a gap.
/// @param spacing_m  of each line, from its windows
RowBlocks split_blocks(const std::vector<RowCurve>& lines, const std::vector<double>& spacing_m);

}  // namespace vinerow::mapping
