#pragma once
/// Neighbouring fields around a parcel, for pictures taken from the air: vineyards with rows of
/// other bearings, meadows and stubble, tracks between them and trees at their edges.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "engine/api/parameters.h"
#include "engine/api/scenery.h"

namespace vinerow::worlds {

/// The group `neighbours`.
std::vector<ParameterSpec> neighbours_parameters();

struct NeighboursOptions {
  int count = 24;                         ///< fields
  std::vector<Eigen::Vector2d> meadow_W;  ///< places to be left free of rows and trees
  double meadow_radius_m = 60.0;
};

/// Divides the ground between parcel and box into fields: four blocks around the parcel, then
/// always the largest one across its longer side.
/// @param parcel_W  its oblong boundary, counter-clockwise, m @param box_W  the box's corners,
/// likewise, around it
/// @param seed  of the plants; a stream of its own is drawn from
Scenery lay_neighbours(const std::vector<Eigen::Vector2d>& parcel_W,
                       const std::vector<Eigen::Vector2d>& box_W, const NeighboursOptions& options,
                       std::uint64_t seed);

/// Reads the group and lays the fields; nothing where it is absent.
/// @throws ConfigError "neighbours: surroundings_m = 6 m leaves no room for fields, needs 60 m"
Scenery read_neighbours(const ParameterSet& parameters,
                        const std::vector<Eigen::Vector2d>& parcel_W, double surroundings_m,
                        std::uint64_t seed);

}  // namespace vinerow::worlds
