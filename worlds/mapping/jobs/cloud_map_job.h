#pragma once
/// Job `cloud_map`: makes a low-complexity map from a point cloud, like `vinerow map`, and compares
/// it with the truth if the cloud has a truth file.

#include "engine/api/registry.h"

namespace vinerow::mapping {

/// Takes `cloud`, gives a map: its folder (docs/guides/mapping.md) with the class of each point
/// (map_points.h), and the map that a vehicle with `map: {type: cloud_map, folder: ...}` would get.
void register_cloud_map_job(Registry& registry);

}  // namespace vinerow::mapping
