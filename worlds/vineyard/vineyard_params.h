#pragma once
/// Parameters of the world `vineyard`.

#include <filesystem>
#include <optional>

#include "engine/api/parameter_table_fwd.h"
#include "engine/math/angles.h"
#include "worlds/mapping/from_truth/map_parameters.h"
#include "worlds/parts/common.h"
#include "worlds/parts/neighbours.h"
#include "worlds/parts/obstacles.h"
#include "worlds/parts/terrain.h"
#include "worlds/plants/vine_rows.h"

namespace vinerow::worlds {

/// Defaults: Parcel F of a Barolo vineyard (Biosystems Engineering 2022).
struct VineyardParams {
  /// The parcel, and the ground within the default margin around it, have the slope of the rows.
  static constexpr double kGroundMargin_m = 6.0;

  int row_count = 16;
  double row_length_m = 118.0;
  double pitch_m = 2.5;
  double vine_spacing_m = 0.9;
  double missing_vine_share = 0.01;
  double row_bearing_rad = rad_from_deg(80.0);  ///< from north, clockwise
  double row_bend_rad = 0.0;                    ///< to the left, from end to end
  double headland_m = 10.0;
  /// The middle of 44.6150 to 44.6157 deg north, 7.9244 to 7.9262 deg east, seen from the corner.
  Eigen::Vector2d centre_W = {71.4, 38.9};
  std::optional<double> relief_m;  ///< absent: 30 m for each 118 m of row length
  double uphill_bearing_rad = rad_from_deg(92.0);
  double surroundings_m = kGroundMargin_m;
  double slope_fade_m = 200.0;
  std::filesystem::path mesh_folder;  ///< empty: find_cache_folder()
  VinePlanting planting;
  TerrainParams terrain{.waves_m = 1.5};
  GeoOrigin origin{rad_from_deg(44.6150), rad_from_deg(7.9244), 300.0};
  Surroundings surroundings;
  std::optional<NeighboursParams> neighbours;
  mapping::MapParams map;
  ObstaclesParams obstacles;
};

const ParameterTable<VineyardParams>& vineyard_table();

}  // namespace vinerow::worlds
