#pragma once
/// Simple flight plans: plans of ground vehicles lifted into the air, and a hover at one place.

#include "engine/api/messages/path.h"

namespace vinerow::controllers {

/// True if a plan contains its own take-off or landing.
bool has_vertical(const PlannedPath& plan);

/// A plan on the ground flown `height_m` above it: straight up from the vehicle's place, straight
/// to the first point, along the plan, straight down at its end.
/// @param start_W  of B, on the ground  @param rest_height_m  height of B above the ground then
/// @pre plan has points
PlannedPath lift_plan(const PlannedPath& plan, const Eigen::Vector3d& start_W, double height_m,
                      double rest_height_m);

/// Straight up to hover_W's height, straight to it, straight down to the height it started from.
PlannedPath make_hover_plan(const Eigen::Vector3d& start_W, const Eigen::Vector3d& hover_W);

}  // namespace vinerow::controllers
