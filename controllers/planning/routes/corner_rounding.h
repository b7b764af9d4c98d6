#pragma once
/// Corners of a polyline rounded for vehicles that do not turn on the spot.
///
/// A corner of angle a between two straights is rounded by an arc of radius R that touches both,
/// R tan(a / 2) before and behind it; the arc passes the corner at R (1 / cos(a / 2) - 1). Where a
/// leg is too short for that, and beyond 120 deg, where the arc would begin farther than sqrt(3) R
/// before the corner, the vehicle drives the shortest way of least radius (Dubins) from so far
/// before to so far behind the corner: a loop.

#include <optional>
#include <string>
#include <vector>

#include "controllers/parts/paths/path_pieces.h"
#include "engine/api/vehicle.h"

namespace vinerow::controllers {

struct RoundedWay {
  PathPieces pieces;
  int arcs = 0, loops = 0;
};

/// Straights of kind `kind`, corners of kind kTurn; each corner takes at most half of a leg that
/// ends in another one. What is left as it is: corners of less than 5 deg, and those of less than
/// 30 deg whose arc does not fit.
/// @param points  >= 2, consecutive ones differ  @param speed_mps  of each leg, points.size() - 1
/// @param radius_m  > 0
RoundedWay round_corners(const std::vector<Eigen::Vector2d>& points,
                         const std::vector<double>& speed_mps, double radius_m, PathKind kind);

/// Radius with which a vehicle's corners are rounded: the wanted one; else 1.1 times the least of a
/// vehicle that steers by its axles, because feedback needs some of the steering too; 0 for what
/// turns on the spot. @throws ConfigError where the wanted one is tighter than the vehicle turns
double find_corner_radius_m(const std::optional<double>& wanted_m,
                            const VehicleDescription& vehicle, const std::string& who);

}  // namespace vinerow::controllers
