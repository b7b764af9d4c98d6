#pragma once
/// World `orchard`: the parametric orchard of Martelli, Mocera, Soma, "Autonomous Driving Strategy
/// for a Specialized Four-Wheel Differential-Drive Agricultural Rover", AgriEngineering 6 (2024),
/// section 2.2, with fruit trees.

#include "engine/api/messages/grid.h"
#include "engine/api/registry.h"

namespace vinerow::worlds {

/// Values of the paper. Field: x from 0 to L1, y from 0 to L2; plant row k = 1..n is centred on x =
/// k P.
struct OrchardLayout {
  int plant_rows = 9;             ///< n
  double row_width_m = 2.0;       ///< w
  double row_length_m = 80.0;     ///< l
  double field_width_m = 100.0;   ///< L1
  double field_length_m = 100.0;  ///< L2
  double row_start_y_m = 10.0;    ///< Ys
  double refinement_per_m2 = 4;   ///< m: elements of the map matrix per square metre

  int free_rows() const { return plant_rows + 1; }                   ///< N = n + 1 (eq. 3)
  double step_m() const { return field_width_m / free_rows(); }      ///< P = L1 / N (eq. 4)
};

/// @throws ConfigError if the rows do not fit into the field
void validate(const OrchardLayout& layout);

/// Map matrix of the paper: 1 for elements whose centre is in a plant row, 0 for free ones.
OccupancyGrid make_occupancy(const OrchardLayout& layout);

void register_orchard(Registry& registry);

}  // namespace vinerow::worlds
