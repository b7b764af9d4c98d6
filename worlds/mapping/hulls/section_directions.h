#pragma once
/// Choice of the directions that the sides of all sections of a row share.

#include <vector>

#include "worlds/mapping/hulls/hull_chain.h"
#include "worlds/mapping/hulls/row_sections.h"

namespace vinerow::mapping {

/// Level that one value in a hundred exceeds: offset of a side that strays do not push out.
/// @param values  not empty; reordered
float upper_level(std::vector<float>& values);

/// Chooses `corners` of 32 directions for a small total area of the polygons around the slices of
/// all stretches: greedily removes the direction that adds the least area.
HullDirections choose_directions(const std::vector<RowStretch>& stretches, int corners);

}  // namespace vinerow::mapping
