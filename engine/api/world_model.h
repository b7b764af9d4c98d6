#pragma once
/// The truth about a world, as plain data: terrain, meshes, rows, soil. Built once by a World part,
/// then constant.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/height_field.h"
#include "engine/api/map.h"
#include "engine/api/mesh.h"
#include "engine/api/scenery.h"
#include "engine/api/wind.h"

namespace vinerow {

/// Where W's origin is on the WGS84 ellipsoid.
struct GeoOrigin {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;  ///< above the ellipsoid
};

/// What a wheel feels. Sources of the built-in soils: vehicles/parts/README.md.
struct Soil {
  std::string name = "dry_grass";
  double peak_friction = 0.75;                ///< largest force / load
  double sliding_friction = 0.65;             ///< force / load at full slip
  double slip_stiffness = 15.0;               ///< d(force/load)/d(slip) at zero slip
  double cornering_stiffness_per_rad = 10.0;  ///< d(force/load)/d(slip angle) at zero
  double rolling_resistance = 0.06;           ///< force / load
};

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
  RowMap rows;  ///< true rows and alleys
  Soil soil;
  std::vector<SpawnPoint> spawn_points;
  Daylight daylight;
  Wind wind;
  Scenery scenery;  ///< for pictures alone
  std::vector<std::string>
      notes;  ///< what the loader wants the user to know (missing textures, ...)
  /// Another seed of the run makes another world. A world that says no here takes nothing from
  /// WorldContext's seed but `wind.random_gust_seed`, and a run that begins again with another seed
  /// keeps it as it is.
  bool depends_on_seed = true;
};

}  // namespace vinerow
