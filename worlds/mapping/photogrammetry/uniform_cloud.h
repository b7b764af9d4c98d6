#pragma once
/// Uniform cloud: points spread evenly over all surfaces of a world, including undersides, insides
/// of canopies and hidden ground. Visibility is ignored; for unit tests and for clouds of a given
/// quality.
///
/// Every square metre of surface gets `density_per_m2` points on average: the ground one in each
/// cell of a grid (more if it is steep), a mesh the integer part of density times area in each
/// triangle and one more at random. Surfaces inside other meshes are sampled as well.

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

/// Samples, within the area, the terrain and the meshes that collide and are canopy, posts, trunks,
/// ground or obstacles.
/// @throws ConfigError: options out of range, a density as CloudTiles
CloudTally sample_uniformly(const WorldModel& world, const SurveyArea& area,
                            const UniformCloudOptions& options, const CloudSink& sink);

}  // namespace vinerow::mapping
