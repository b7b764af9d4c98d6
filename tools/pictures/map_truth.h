#pragma once
/// How far a map is from what is true of its parcel, for a terminal.

#include <string>

#include "worlds/mapping/photogrammetry/map_comparison.h"

namespace vinerow::tools {

/// A table: all rows together, then row by row.
std::string comparison_text(const mapping::MapComparison& comparison, const mapping::CloudMap& map,
                            const mapping::CloudTruth& truth);

}  // namespace vinerow::tools
