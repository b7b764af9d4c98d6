#pragma once
/// Low-complexity map made from a point cloud, with a report on its quality.
///
/// Source: paper A, section 3 (Mammarella et al., Biosystems Engineering 223, 2022), after Comba et
/// al., Computers and Electronics in Agriculture 155 (2018), and Biosystems Engineering 197 (2020).

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/api/map.h"
#include "engine/math/geo_origin.h"

namespace vinerow::mapping {

/// Figures of one row. Lengths in m along the row's line.
struct MappedRowFigures {
  int row = 0;                                              ///< PlantRow::id
  int block = 0;                                            ///< block of the row
  Eigen::Vector3d first_W = {0, 0, 0}, last_W = {0, 0, 0};  ///< the canopy's ends, on the ground
  double length_m = 0.0;
  double bearing_deg = 0.0;     ///< first to last point, clockwise from north
  double spacing_m = 0.0;       ///< mean distance to the next row; 0: the last row
  double canopy_base_m = 0.0;   ///< above the ground, mean over the row
  double canopy_top_m = 0.0;    ///< above the ground, mean over the row
  double canopy_width_m = 0.0;  ///< mean over the row
  double volume_m3 = 0.0;       ///< inside its meshes
  double seen_volume_m3 = 0.0;  ///< estimate of the seen canopy without the bias of noise
  double containment = 0.0;     ///< share of its points within 1 cm of the inside of its meshes
  std::int64_t points = 0;      ///< of canopy
  std::int64_t triangles = 0;
  std::vector<std::pair<double, double>> gaps_m;  ///< without canopy, from and to along the line
};

/// Time and memory of a phase. They differ from run to run; the map does not depend on them.
struct MapPhase {
  std::string name;  ///< "read", "terrain", "rows", "meshes", "grid"
  double wall_s = 0.0;
  double peak_memory_MB = 0.0;  ///< of the process at the end of the phase
};

struct CloudMapReport {
  std::string file, format, crs;
  std::int64_t cloud_bytes = 0;  ///< of the file
  std::int64_t points = 0;       ///< read
  std::int64_t not_finite = 0;   ///< left out
  std::int64_t ground_points = 0, low_points = 0, canopy_points = 0, other_points = 0;
  double density_per_m2 = 0.0;                  ///< points over the ground that the cloud covers
  double noise_m = 0.0;                         ///< 1 sigma of ground points about the terrain
  double bearing_deg = 0.0;                     ///< mean of the rows, [0, 180)
  double spacing_m = 0.0, spacing_std_m = 0.0;  ///< between neighbouring rows
  double canopy_top_m = 0.0, canopy_width_m = 0.0, volume_m3 = 0.0;  ///< means, sum
  double seen_volume_m3 = 0.0;                                       ///< sum
  double containment = 0.0;  ///< share of all canopy points within 1 cm of their row's meshes
  std::int64_t triangles = 0;
  std::int64_t mesh_bytes = 0;  ///< of the row meshes as binary PLY
  double reduction = 0.0;       ///< 1 - mesh_bytes / cloud_bytes
  std::vector<MappedRowFigures> rows;
  std::vector<MapPhase> phases;
  std::vector<std::string> notes;  ///< whole sentences for the user
};

struct CloudMap {
  GeoOrigin origin;  ///< of W; all zero if the cloud has no CRS and none was given
  bool has_origin = false;
  RowMap map;  ///< rows, alleys, boundary, occupancy, meshes, accuracy, terrain
  CloudMapReport report;
  /// If the cloud contains several blocks of rows: a separate map for each, with rows and alleys
  /// counted from 0. `map` then contains all of them, numbered consecutively, for display and
  /// measurement: alleys are between rows of one block, and the grid has no virtual walls. Empty
  /// for one block.
  std::vector<CloudMap> blocks;
};

}  // namespace vinerow::mapping
