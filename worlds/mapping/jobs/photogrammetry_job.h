#pragma once
/// The job `photogrammetry`: pictures of a survey into a point cloud, as `vinerow cloud --log`
/// makes it. What is modelled: worlds/mapping/photogrammetry/photogrammetry.h.

#include "engine/api/registry.h"

namespace vinerow::mapping {

/// Takes `pictures`, gives a cloud: <folder>/cloud.las with cloud.truth.json beside it.
void register_photogrammetry_job(Registry& registry);

}  // namespace vinerow::mapping
