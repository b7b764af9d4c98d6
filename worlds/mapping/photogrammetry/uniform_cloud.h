#pragma once
/// Points spread evenly over all surfaces of a world: undersides, insides of canopies and hidden
/// ground too. No camera has seen them; for unit tests and for clouds of a given quality.
///
/// Every square metre of surface gets `density_per_m2` points in the mean: the ground one in each
/// cell of a grid (more where it is steep), a mesh the whole part of density times area in each
/// triangle and by chance one more. What meshes hide in each other is sampled as well.

#include <cstdint>

#include "engine/api/forward.h"
#include "worlds/mapping/photogrammetry/photogrammetry.h"
#include "worlds/mapping/photogrammetry/weeds.h"

namespace vinerow::mapping {

struct UniformCloudOptions {
  double density_per_m2 = 200.0;  ///< of surface
  double noise_m = 0.0;           ///< 1 sigma along each axis
  WeedsOptions weeds;             ///< points of the ground are lifted by 0.5 to 1 of its height
  double outliers = 0.0;          ///< share of points that are put 2 m below to 8 m above their
                                  ///< surface, anywhere between, without noise
  std::uint64_t seed = 1;
};

/// Meshes that collide and are canopy, posts, trunks, ground or obstacles, and the terrain, where
/// they are within the area.
/// @throws ConfigError: options out of range, a density as CloudTiles
CloudTally sample_uniformly(const WorldModel& world, const SurveyArea& area,
                            const UniformCloudOptions& options, const CloudSink& sink);

}  // namespace vinerow::mapping
