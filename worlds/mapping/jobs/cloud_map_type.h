#pragma once
/// The map `cloud_map`: what `vinerow map` made of a point cloud, told to a vehicle.

#include <string>

#include "engine/api/registry.h"
#include "worlds/mapping/model/cloud_map.h"

namespace vinerow::mapping {

/// A loaded map as a vehicle of the world is told it, where nothing more is asked for: in the
/// world's frame, and numbered like the world's rows where `like_world`.
/// @param folder  of the map, for errors
/// @throws ConfigError: the map lies elsewhere than the world's rows
RowMap map_in_world(CloudMap map, bool like_world, const MapContext& context,
                    const std::string& folder);

/// Rows, alleys, boundary, meshes, accuracy, terrain and occupancy of a map's folder, in the
/// world's frame: where both have an origin the map is moved to the world's, else its coordinates
/// are taken for the world's.
/// @throws ConfigError as load_map(); where the map lies elsewhere than the world's rows, with the
/// distance; where a grid is to be drawn and cannot be
std::unique_ptr<RowMap> make_map_of_folder(const ParameterSet& parameters,
                                           const MapContext& context);

void register_cloud_map(Registry& registry);

}  // namespace vinerow::mapping
