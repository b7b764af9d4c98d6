#pragma once
/// The directions that the sides of all of a row's sections look in.

#include <vector>

#include "worlds/mapping/hulls/hull_chain.h"
#include "worlds/mapping/hulls/row_sections.h"

namespace vinerow::mapping {

/// The level that one value in a hundred is above: where a side lies when no stray may push it out.
/// @param values  not empty; left in another order
float upper_level(std::vector<float>& values);

/// The `corners` of 32 directions whose polygons around the slices of all stretches have the least
/// area in sum, found by taking away what adds least, again and again.
/// @param excess  if not null: how much larger these polygons are, in sum, than the smallest ones
/// of as many corners around the same slices (enclosing_polygon.h); what it costs that all slices
/// share their directions. 0 where there are no slices to tell.
HullDirections choose_directions(const std::vector<RowStretch>& stretches, int corners,
                                 double* excess = nullptr);

}  // namespace vinerow::mapping
