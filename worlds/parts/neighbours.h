#pragma once
/// Neighbouring fields around a parcel, for pictures taken from the air: vineyards with rows of
/// other bearings, meadows and stubble, tracks between them and trees at their edges.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/api/scenery.h"

namespace vinerow::worlds {

struct NeighboursOptions {
  int count = 24;                         ///< fields
  std::vector<Eigen::Vector2d> meadow_W;  ///< places to be left free of rows and trees
  double meadow_radius_m = 60.0;
};

struct NeighboursParams {
  NeighboursOptions options;     ///< without meadow_W
  std::vector<double> meadow_m;  ///< x and y of a place, or nothing
};
/// `count`, `meadow_m`, `meadow_radius_m`.
const ParameterTable<NeighboursParams>& neighbours_table();

/// Divides the ground between parcel and box into fields: four blocks around the parcel, then
/// always the largest one across its longer side.
/// @param parcel_W  its oblong boundary, counter-clockwise, m @param box_W  the box's corners,
/// likewise, around it
/// @param seed  of the plants; a stream of its own is drawn from
Scenery lay_neighbours(const std::vector<Eigen::Vector2d>& parcel_W,
                       const std::vector<Eigen::Vector2d>& box_W, const NeighboursOptions& options,
                       std::uint64_t seed);

/// Lays the fields as the parameters say.
/// @throws ConfigError "neighbours: surroundings_m = 6 m leaves no room for fields, needs 60 m"
Scenery make_neighbours(const NeighboursParams& params,
                        const std::vector<Eigen::Vector2d>& parcel_W, double surroundings_m,
                        std::uint64_t seed);

}  // namespace vinerow::worlds
