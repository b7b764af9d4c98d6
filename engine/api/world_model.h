#pragma once
/// True world, as plain data: terrain, meshes, rows, soil. A World part builds it once; then it is
/// constant.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/height_field.h"
#include "engine/api/mesh.h"
#include "engine/api/scenery.h"
#include "engine/api/soil.h"
#include "engine/api/wind.h"
#include "engine/core/indirect.h"
#include "engine/math/geo_origin.h"

namespace vinerow {

/// Start position of a vehicle.
struct SpawnPoint {
  std::string name;
  Eigen::Vector2d p_W = {0, 0};
  double yaw_rad = 0.0;
};

/// Sun position and clouds, for pictures and cameras.
struct Daylight {
  double sun_azimuth_rad = 2.6;  ///< from north, clockwise
  double sun_elevation_rad = 0.75;
  double cloud_cover = 0.0;  ///< share of the sky, 0 clear to 1 overcast
};

struct WorldModel {
  std::string name;
  GeoOrigin origin;
  std::optional<HeightField> terrain;  ///< absent if the ground is a mesh of class kTerrain
  std::vector<MeshInstance> meshes;
  Indirect<RowMap> rows;  ///< true rows and alleys; include map.h to access them
  Soil soil;
  std::vector<SpawnPoint> spawn_points;
  Daylight daylight;
  Wind wind;
  Scenery scenery;                 ///< for pictures alone
  std::vector<std::string> notes;  ///< messages of the loader to the user (missing textures, ...)
  /// Whether another seed of the run makes another world. If false, the world uses WorldContext's
  /// seed only as `wind.random_gusts->seed`, and a run that is reset with another seed keeps the
  /// world.
  bool depends_on_seed = true;
};

}  // namespace vinerow
