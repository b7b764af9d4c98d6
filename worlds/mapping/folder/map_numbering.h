#pragma once
/// Numbers a map's rows and alleys as another block counts them.

#include "engine/api/forward.h"

namespace vinerow::mapping {

/// Where `wanted` counts its rows from the other side of the block, or its lines run the other way,
/// the map's rows and alleys are put into that order, numbered anew from 0, and turned; meshes go
/// with their rows. What stands where stays as it is. The occupancy grid is drawn anew with cells
/// of the same size where it holds the virtual walls of the old order, and those of the new one
/// stand elsewhere.
/// @pre both have rows of at least two points
/// @returns whether anything was changed
bool number_like(const RowMap& wanted, RowMap& map);

}  // namespace vinerow::mapping
