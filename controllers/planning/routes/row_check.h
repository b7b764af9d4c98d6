#pragma once
/// Does a path run into a plant row?

#include <optional>
#include <string>

#include "engine/api/forward.h"

namespace vinerow::controllers {

/// Looks at every stretch between two points of a path, as driven straight.
/// @param clearance_m  to keep from the canopy's footprint, >= 0
/// @returns nothing if the path is free, else one sentence: "path into a row: ..."
std::optional<std::string> find_path_into_row(const PlannedPath& path, const RowMap& map,
                                              double clearance_m);

}  // namespace vinerow::controllers
