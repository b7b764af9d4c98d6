#pragma once
/// Renumbering of a map's rows and alleys to match another block.

#include "engine/api/forward.h"

namespace vinerow::mapping {

/// If `wanted` counts its rows from the other side of the block, or its lines have the opposite
/// direction, the map's rows and alleys are put into that order, renumbered from 0 and reversed;
/// meshes stay with their rows. No geometry moves. If the occupancy grid contains virtual walls and
/// those of the new order are in other places, it is redrawn with cells of the same size.
/// @pre both have rows of at least two points
/// @returns true if anything was changed
bool number_like(const RowMap& wanted, RowMap& map);

}  // namespace vinerow::mapping
