#pragma once
/// Rounding of a polyline's corners for vehicles that do not turn on the spot.
///
/// A corner of angle a between two straights is rounded by an arc of radius R that touches both, R
/// tan(a / 2) before and behind it. The arc passes the corner at the distance R (1 / cos(a / 2) -
/// 1). If a leg is too short for that, or if the angle exceeds 120 deg, at which the arc starts
/// sqrt(3) R before the corner, the vehicle drives the Dubins path from a point before the corner
/// to one at the same distance behind it: a loop.

#include <optional>
#include <string>
#include <vector>

#include "controllers/parts/paths/path_pieces.h"
#include "engine/api/vehicle.h"

namespace vinerow::controllers {

struct RoundedPath {
  PathSegments pieces;
  int arcs = 0, loops = 0;
};

/// Straights of kind `kind`, corners of kind kTurn; each corner uses at most half of a leg that
/// ends in another corner. Corners of less than 5 deg stay, and so do those of less than 30 deg
/// whose arc does not fit.
/// @param points  >= 2, consecutive ones differ  @param speed_mps  of each leg, points.size() - 1
/// @param radius_m  > 0
RoundedPath round_corners(const std::vector<Eigen::Vector2d>& points,
                          const std::vector<double>& speed_mps, double radius_m, PathKind kind);

/// Radius of a vehicle's rounded corners: the wanted one; else 1.1 times the minimum radius of a
/// vehicle with axle steering, because feedback needs a part of the steering angle; 0 for vehicles
/// that turn on the spot. @throws ConfigError if the wanted one is tighter than the vehicle can
/// turn
double find_corner_radius_m(const std::optional<double>& wanted_m,
                            const VehicleDescription& vehicle, const std::string& who);

}  // namespace vinerow::controllers
