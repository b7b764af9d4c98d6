#pragma once
/// Flights made of little: plans of ground vehicles lifted into the air, and holding one place.

#include "engine/api/messages/path.h"

namespace vinerow::controllers {

/// True where a plan says itself how to take off or land.
bool has_vertical(const PlannedPath& plan);

/// A plan on the ground flown `height_m` above it: straight up where the vehicle stands, straight
/// to the first point, along the plan, straight down at its end.
/// @param start_W  of B, standing  @param standing_m  height of B above the ground then
/// @pre plan has points
PlannedPath lift_plan(const PlannedPath& plan, const Eigen::Vector3d& start_W, double height_m,
                      double standing_m);

/// Straight up to hover_W's height, straight to it, straight down to the height it started from.
PlannedPath make_hover_plan(const Eigen::Vector3d& start_W, const Eigen::Vector3d& hover_W);

}  // namespace vinerow::controllers
