#pragma once
/// Occupancy grid of a parcel: rows, boundary, and virtual walls that leave only the serpentine
/// free.
///
/// Source: Mammarella et al., "Cooperation of unmanned systems for agricultural applications: A
/// case study in a vineyard", Biosystems Engineering 223 (2022), section 3.1. The paper takes "the
/// closest" boundary hit of a row's tangent; here it is the first one ahead, which is also correct
/// for non-convex parcels.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/messages/grid.h"
#include "worlds/mapping/grid/virtual_walls.h"

namespace vinerow::mapping {

struct OccupancyOptions {
  double cell_m = 0.05;  ///< > 0
  bool virtual_walls = true;
  std::optional<RowEnd> first_wall;  ///< end of row 0 with a wall; absent: first_wall_of(map)
  double row_end_margin_m = 0.0;     ///< extension of rows beyond their ends, >= 0
  std::vector<std::vector<Eigen::Vector2d>> obstacles_W;  ///< further occupied areas
  std::int64_t cell_limit = 100'000'000;
};

/// Report on the making of a grid.
struct OccupancyReport {
  std::vector<VirtualWall> walls;
  std::vector<TurningArea> turning_areas;
  std::vector<std::string> notes;  ///< one sentence for each row without a wall
};

/// Walls and turning areas alone, without a grid; empty if `virtual_walls` is off.
OccupancyReport plan_occupancy(const RowMap& map, const OccupancyOptions& options);

/// Makes the grid. Occupied are cells whose centre is outside the parcel, in the strip of a row
/// (half the canopy's width to each side of its line, square ends, mitred at bends) or in an
/// obstacle, and every cell that the boundary or a virtual wall touches. All others are free. Cost:
/// 4 million cells in about 10 ms.
/// @param map     with rows and boundary
/// @param report  of plan_occupancy() with the same arguments
/// @throws ConfigError if there is no boundary of at least three corners, or with too many cells
OccupancyGrid make_occupancy_grid(const RowMap& map, const OccupancyOptions& options,
                                  const OccupancyReport& report);
OccupancyGrid make_occupancy_grid(const RowMap& map, const OccupancyOptions& options);

/// Cell size that keeps a parcel's grid within a number of cells: the wanted one if it fits, else a
/// larger one in whole millimetres.
double cell_that_fits_m(const std::vector<Eigen::Vector2d>& boundary_W, double cell_m,
                        std::int64_t max_cells);

/// Share of cells that are free.
double free_share(const OccupancyGrid& grid);

}  // namespace vinerow::mapping
