#pragma once
/// Map `cloud_map`: the result of `vinerow map` as the map of a vehicle.

#include <string>

#include "engine/api/registry.h"
#include "worlds/mapping/model/cloud_map.h"

namespace vinerow::mapping {

/// A loaded map as a vehicle of the world gets it by default: in the world's frame, and numbered
/// like the world's rows if `like_world`.
/// @param folder  of the map, for errors
/// @throws ConfigError if the map is not where the world's rows are
RowMap map_in_world(CloudMap map, bool like_world, const MapContext& context,
                    const std::string& folder);

/// Rows, alleys, boundary, meshes, accuracy, terrain and occupancy of a map's folder, in the
/// world's frame. If both have an origin, the map is moved to the world's; else its coordinates are
/// taken as the world's.
/// @throws ConfigError as load_map(); if the map is not where the world's rows are, with the
/// distance; if a required grid cannot be made
std::unique_ptr<RowMap> make_map_of_folder(const ParameterSet& parameters,
                                           const MapContext& context);

void register_cloud_map(Registry& registry);

}  // namespace vinerow::mapping
