#pragma once
/// The truth about a world, as plain data: terrain, meshes, rows, soil. Built once by a World part,
/// then constant.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

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

/// Regular grid of heights; x east, y north. Between samples the surface is two flat triangles per
/// cell, split along the diagonal from (i, j) to (i+1, j+1), in physics, rays and pictures alike.
struct HeightField {
  int columns = 0;                    ///< samples along x, >= 2
  int rows = 0;                       ///< samples along y, >= 2
  double cell_m = 1.0;                ///< distance between samples
  Eigen::Vector2d corner_W = {0, 0};  ///< position of sample (0, 0)
  std::vector<float> heights_m;       ///< rows * columns, x fastest

  double width_m() const { return (columns - 1) * cell_m; }
  double depth_m() const { return (rows - 1) * cell_m; }
  bool contains(double x, double y) const {
    return x >= corner_W.x() && y >= corner_W.y() && x <= corner_W.x() + width_m() &&
           y <= corner_W.y() + depth_m();
  }
  /// Height of the triangle surface. Outside the grid the nearest edge's height continues.
  double height_m(double x, double y) const;
  /// Upward unit normal of the triangle under (x, y); +z outside.
  Eigen::Vector3d normal_W(double x, double y) const;
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
};

}  // namespace vinerow
