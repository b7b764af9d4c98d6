#pragma once
/// The whole way from the points of a parcel to its low-complexity map: ground, rows, row meshes,
/// occupancy grid.
///
/// Source: paper A, section 3 (Mammarella et al., Biosystems Engineering 223, 2022), after Comba et
/// al., Computers and Electronics in Agriculture 155 (2018), and Biosystems Engineering 197 (2020).
/// Neither of them prints its inner workings; those here are ours, each in its own file.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "worlds/mapping/grid/occupancy.h"
#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::mapping {

struct CloudMapOptions {
  double terrain_cell_m = 1.0;    ///< of the map's ground
  double canopy_cut_m = 0.55;     ///< what is higher above the ground may be a row
  double spacing_low_m = 1.0;     ///< rows are looked for at least so far apart
  double spacing_high_m = 6.0;    ///< and at most so far
  double row_length_low_m = 5.0;  ///< shorter ones are no rows
  double headland_m = 5.0;        ///< beyond row ends and outer rows, where no boundary is given
  std::vector<Eigen::Vector2d> boundary_W;  ///< of the parcel, or empty
  int corners = 8;                          ///< of a cross-section
  double slice_m = 0.14;                    ///< between cross-sections, before any is left out
  double gap_m = 0.5;                       ///< a longer stretch without canopy splits a row's mesh
  double budget_MB = 0.0;      ///< of all row meshes as binary PLY; 0: 1.3 kB per metre of row
  OccupancyOptions occupancy;  ///< cell_m = 0: no grid
};

/// @throws ConfigError: out of range, or such as do not fit together
void check_options(const CloudMapOptions& options);

/// @param cloud     gets a class for every point
/// @param on_phase  called with each phase's name when it ends, or empty
/// @returns the map (CloudMap::blocks where there are several) with a report of everything but the
/// file: file, format, crs, cloud_bytes, not_finite, reduction, phases and origin are the caller's
/// @throws ConfigError in a sentence: no rows found (with what was seen instead), options that do
/// not fit together
CloudMap make_cloud_map(ParcelCloud& cloud, const CloudMapOptions& options,
                        const std::function<void(const std::string&)>& on_phase = {});

}  // namespace vinerow::mapping
