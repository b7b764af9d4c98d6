#pragma once
/// Check of whether a path runs into a plant row.

#include <optional>
#include <string>

#include "engine/api/forward.h"

namespace vinerow::controllers {

/// Checks the straight line between every two consecutive points of a path.
/// @param clearance_m  to keep from the canopy's footprint, >= 0
/// @param vehicle      if given and on the ground: its outline along the path must not cross the
/// rows' centre lines, on which posts and trunks are
/// @returns nullopt if the path is free, else one sentence: "path into a row: ..."
std::optional<std::string> find_path_into_row(const PlannedPath& path, const RowMap& map,
                                              double clearance_m,
                                              const VehicleDescription* vehicle = nullptr);

}  // namespace vinerow::controllers
