#pragma once
/// The occupancy grid of a parcel: rows, boundary, and virtual walls that leave the serpentine as
/// the only way through.
///
/// Source: Mammarella et al., "Cooperation of unmanned systems for agricultural applications: A
/// case study in a vineyard", Biosystems Engineering 223 (2022), section 3.1. The paper takes "the
/// closest" boundary hit of a row's tangent; here it is the first one ahead, so that parcels with
/// bays are right too.

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
  std::optional<RowEnd> first_wall;  ///< end of row 0 that is walled; absent: first_wall_of(map)
  double row_end_margin_m = 0.0;     ///< rows are taken this far beyond their ends, >= 0
  std::vector<std::vector<Eigen::Vector2d>> obstacles_W;  ///< further areas that are taken
  std::int64_t cell_limit = 100'000'000;
};

/// What the grid was made of.
struct OccupancyReport {
  std::vector<VirtualWall> walls;
  std::vector<TurningArea> turning_areas;
  std::vector<std::string> notes;  ///< rows without wall, each in a sentence
};

/// Walls and turning areas alone, without a grid; nothing where `virtual_walls` is off.
OccupancyReport plan_occupancy(const RowMap& map, const OccupancyOptions& options);

/// Taken are: cells whose centre lies outside the parcel or inside a row's strip (its line, half
/// the canopy's width to each side, square ends, mitred at bends) or an obstacle, and every cell
/// that the boundary or a virtual wall touches. Everything else is free. Cost: 4 million cells in
/// about 10 ms.
/// @param map     with rows and boundary
/// @param report  of plan_occupancy() with the same arguments
/// @throws ConfigError where there is no boundary of at least three corners, or too many cells
OccupancyGrid make_occupancy_grid(const RowMap& map, const OccupancyOptions& options,
                                  const OccupancyReport& report);
OccupancyGrid make_occupancy_grid(const RowMap& map, const OccupancyOptions& options);

/// The cell that keeps a parcel's grid within a number of cells: the wanted one where it fits, else
/// a larger one in whole millimetres.
double cell_that_fits_m(const std::vector<Eigen::Vector2d>& boundary_W, double cell_m,
                        std::int64_t most_cells);

/// Share of cells that are free.
double free_share(const OccupancyGrid& grid);

}  // namespace vinerow::mapping
