#pragma once
/// Neighbouring fields around a parcel, for aerial pictures: vineyards with rows of other bearings,
/// meadows and stubble, tracks between them and trees at their edges.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/api/scenery.h"

namespace vinerow::worlds {

struct NeighboursOptions {
  int count = 24;                         ///< fields
  std::vector<Eigen::Vector2d> meadow_W;  ///< places without rows and trees
  double meadow_radius_m = 60.0;
};

struct NeighboursParams {
  NeighboursOptions options;     ///< without meadow_W
  std::vector<double> meadow_m;  ///< x and y of a place, or empty
};
/// `count`, `meadow_m`, `meadow_radius_m`.
const ParameterTable<NeighboursParams>& neighbours_table();

/// Divides the ground between parcel and box into fields: four blocks around the parcel, of which
/// the largest is then halved across its longer side, repeatedly.
/// @param parcel_W  its rectangular boundary, counter-clockwise, m
/// @param box_W  corners of the box around it, likewise
/// @param seed  of the plants, from which a separate stream is derived
Scenery lay_neighbours(const std::vector<Eigen::Vector2d>& parcel_W,
                       const std::vector<Eigen::Vector2d>& box_W, const NeighboursOptions& options,
                       std::uint64_t seed);

/// Lays out the fields by the parameters.
/// @throws ConfigError "neighbours: surroundings_m = 6 m leaves no room for fields, needs 60 m"
Scenery make_neighbours(const NeighboursParams& params,
                        const std::vector<Eigen::Vector2d>& parcel_W, double surroundings_m,
                        std::uint64_t seed);

}  // namespace vinerow::worlds
