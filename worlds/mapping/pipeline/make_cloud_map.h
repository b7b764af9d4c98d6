#pragma once
/// Mapping pipeline from the points of a parcel to its low-complexity map: ground, rows, row
/// meshes, occupancy grid.
///
/// Source: paper A, section 3 (Mammarella et al., Biosystems Engineering 223, 2022), after Comba et
/// al., Computers and Electronics in Agriculture 155 (2018), and Biosystems Engineering 197 (2020).
/// Neither paper gives the algorithms in detail; those here are our own, each in its own file.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "worlds/mapping/grid/occupancy.h"
#include "worlds/mapping/hulls/row_hull.h"
#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/model/parcel_cloud.h"
#include "worlds/mapping/rows/row_lines.h"

namespace vinerow::mapping {

/// Thresholds of the stages. Fields that CloudMapOptions or the cloud itself give (spacings,
/// lengths, corners, slices, gaps, budget) are overwritten.
struct MappingThresholds {
  CloudTerrainOptions terrain;
  RowPatchOptions direction;
  RowTrackingOptions tracking;
  RowLineOptions lines;
  RowHullOptions hulls;
};

struct CloudMapOptions {
  double terrain_cell_m = 1.0;    ///< of the map's ground
  double canopy_cut_m = 0.55;     ///< points higher above the ground may belong to a row
  double spacing_low_m = 1.0;     ///< smallest spacing that is searched
  double spacing_high_m = 6.0;    ///< largest spacing that is searched
  double row_length_low_m = 5.0;  ///< shorter lines are not rows
  double headland_m = 5.0;        ///< beyond row ends and outer rows, if no boundary is given
  std::vector<Eigen::Vector2d> boundary_W;  ///< of the parcel, or empty
  int corners = 8;                          ///< of a cross-section
  double slice_m = 0.14;                    ///< between cross-sections, before any is left out
  double gap_m = 0.5;                       ///< a longer stretch without canopy splits a row's mesh
  double budget_MB = 0.0;      ///< of all row meshes as binary PLY; 0: 1.3 kB per metre of row
  OccupancyOptions occupancy;  ///< cell_m = 0: no grid
  MappingThresholds thresholds;
};

/// @throws ConfigError for options out of range or in contradiction
void check_options(const CloudMapOptions& options);

/// @param cloud     gets a class for every point
/// @param on_phase  called with each phase's name when it ends, or empty
/// @returns the map (with CloudMap::blocks if there are several). The caller completes the report:
/// file, format, crs, cloud_bytes, not_finite, reduction, phases and origin
/// @throws ConfigError in one sentence: no rows found (with what was found instead), options in
/// contradiction
CloudMap make_cloud_map(ParcelCloud& cloud, const CloudMapOptions& options,
                        const std::function<void(const std::string&)>& on_phase = {});

}  // namespace vinerow::mapping
