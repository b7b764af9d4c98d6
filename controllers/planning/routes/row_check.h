#pragma once
/// Check of whether a path runs into a plant row.

#include <optional>
#include <string>

#include "engine/api/forward.h"

namespace vinerow::controllers {

/// Half of the outline's width: a vehicle whose middle passes nearer to a post touches it, m. 0 for
/// vehicles that fly.
double find_half_width_m(const VehicleDescription& vehicle);

/// Checks the straight line between every two consecutive points of a path.
/// @param clearance_m   to keep from the canopy's footprint, >= 0
/// @param half_width_m  of a vehicle whose middle keeps as far from the rows' centre lines, on
/// which posts and trunks are; 0: not checked
/// @returns nullopt if the path is free, else one sentence: "path into a row: ..."
std::optional<std::string> find_path_into_row(const PlannedPath& path, const RowMap& map,
                                              double clearance_m, double half_width_m = 0.0);

}  // namespace vinerow::controllers
