#pragma once
/// Comparison of a map with the truth of its parcel, as text for a terminal.

#include <string>

#include "worlds/mapping/photogrammetry/map_comparison.h"

namespace vinerow::tools {

/// Table: all rows together, then row by row.
std::string comparison_text(const mapping::MapComparison& comparison, const mapping::CloudMap& map,
                            const mapping::CloudTruth& truth);

}  // namespace vinerow::tools
