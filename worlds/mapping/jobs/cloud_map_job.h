#pragma once
/// The job `cloud_map`: a point cloud into a low-complexity map, as `vinerow map` makes it, and its
/// distance from the truth where the cloud has that beside it.

#include "engine/api/registry.h"

namespace vinerow::mapping {

/// Takes `cloud`, gives a map: its folder (docs/guides/mapping.md) with what each point is (map_points.h),
/// and what a vehicle with `map: {type: cloud_map, folder: ...}` would be told of it.
void register_cloud_map_job(Registry& registry);

}  // namespace vinerow::mapping
