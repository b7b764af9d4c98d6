#pragma once
/// The map `cloud_map`: what `vinerow map` made of a point cloud, told to a vehicle.

#include "engine/api/registry.h"

namespace vinerow::worlds {

/// Rows, alleys, boundary, meshes, accuracy, terrain and occupancy of a map's folder, in the
/// world's frame: where both have an origin the map is moved to the world's, else its coordinates
/// are taken for the world's.
/// @throws ConfigError as load_map(); where the map lies elsewhere than the world's rows, with the
/// distance; where a grid is to be drawn and cannot be
std::unique_ptr<RowMap> make_map_of_folder(const ParameterSet& parameters,
                                           const MapContext& context);

void register_cloud_map(Registry& registry);

}  // namespace vinerow::worlds
