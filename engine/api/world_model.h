#pragma once
/// The truth about a world, as plain data: terrain, meshes, rows, soil. Built once by a World part,
/// then constant.

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

/// A place to start from.
struct SpawnPoint {
  std::string name;
  Eigen::Vector2d p_W = {0, 0};
  double yaw_rad = 0.0;
};

/// The look of sky and light.
struct Daylight {
  double sun_azimuth_rad = 2.6;  ///< from north, clockwise
  double sun_elevation_rad = 0.75;
};

struct WorldModel {
  std::string name;
  GeoOrigin origin;
  std::optional<HeightField> terrain;  ///< absent where the ground is a mesh of class kTerrain
  std::vector<MeshInstance> meshes;
  Indirect<RowMap> rows;  ///< true rows and alleys; whoever looks into them includes map.h
  Soil soil;
  std::vector<SpawnPoint> spawn_points;
  Daylight daylight;
  Wind wind;
  Scenery scenery;  ///< for pictures alone
  std::vector<std::string>
      notes;  ///< what the loader wants the user to know (missing textures, ...)
  /// Another seed of the run makes another world. A world that says no here takes nothing from
  /// WorldContext's seed but `wind.random_gusts->seed`, and a run that begins again with another
  /// seed keeps it as it is.
  bool depends_on_seed = true;
};

}  // namespace vinerow
