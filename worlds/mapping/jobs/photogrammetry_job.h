#pragma once
/// Job `photogrammetry`: makes a point cloud from the pictures of a survey, like
/// `vinerow cloud --log`. The model is in worlds/mapping/photogrammetry/photogrammetry.h.

#include "engine/api/registry.h"

namespace vinerow::mapping {

/// Takes `pictures`, gives a cloud: <folder>/cloud.las and cloud.truth.json.
void register_photogrammetry_job(Registry& registry);

}  // namespace vinerow::mapping
