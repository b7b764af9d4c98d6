#pragma once
/// Which rows make up a block: rows side by side, in one direction.

#include <vector>

#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

/// A block's rows, in the order and direction of order_block().
struct RowBlock {
  std::vector<RowCurve> rows;
  double spacing_m = 0.0;  ///< about, between neighbours

  double length_m() const;  ///< of all rows
};

struct RowBlocks {
  std::vector<RowBlock> blocks;  ///< the one with the most metres of rows first
  std::vector<RowCurve> lone;    ///< lines that no row runs beside
};

/// Two rows are of one block where they run beside each other along a quarter of the shorter one,
/// within 6 degrees and 0.5 to 2.6 times the spacing (one row between them may be missing). So a
/// track across all rows, one along them wider than that, and another direction end a block.
/// Pieces in one line of one block are one row with a gap.
/// @param spacing_m  of each line, as its windows tell it
RowBlocks split_blocks(const std::vector<RowCurve>& lines, const std::vector<double>& spacing_m);

}  // namespace vinerow::mapping
