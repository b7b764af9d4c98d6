#pragma once
/// A block of vine rows with its occupancy grid, made by hand: straight rows, a boundary around
/// them, and virtual walls that leave the serpentine as the only way (paper A, section 3.1).

#include "engine/api/map.h"
#include "engine/api/vehicle.h"

namespace vinerow::test {

/// Parcel F's proportions by default (paper A: rows of 118 m, 2.5 m apart).
struct BlockSetup {
  int alleys = 2;
  double row_length_m = 118.0;
  double spacing_m = 2.5;
  double canopy_m = 0.6;
  double headland_m = 10.0;  ///< beyond the row ends, to the boundary
  double side_m = 3.0;       ///< beside the outer rows, to the boundary
  double cell_m = 0.05;
  double turned_rad = 0.0;  ///< the whole block about the origin
  double slant = 0.0;       ///< row i is moved along itself by slant * its place across
  bool has_walls = true;
};

/// In block coordinates rows run along y from 0, alley i lies at x = spacing * (i + 0.5); turned by
/// turned_rad. Taken are cells that a wall or the boundary touches, and cells of the canopies.
RowMap make_block(const BlockSetup& setup);

/// Marks every cell that the rectangle around a segment touches. @param half_width_m  >= 0
void mark(OccupancyGrid& grid, const Eigen::Vector2d& a_W, const Eigen::Vector2d& b_W,
          double half_width_m);

/// Block coordinates to W.
Eigen::Vector2d block_point(const BlockSetup& setup, double x, double y);

/// Description of the rover of paper A for planners: hull 1.5 x 1.0 m, wheel noses to 0.95 m.
VehicleDescription make_four_wheel_description(double min_turning_radius_m = 1.767);

}  // namespace vinerow::test
