#pragma once
/// Straight up and down: how a rotorcraft gets into a plan in the air, and down from it. A plan
/// with a stretch of kind kVertical is one in the air.

#include <Eigen/Core>

#include "engine/api/messages/path.h"

namespace vinerow::controllers {

/// A vehicle nearer than this, seen from above, is at a place.
inline constexpr double kAtPlace_m = 0.05;

/// Begins the plan on the ground: up from start_W to the height of its first point, and over to it.
void add_take_off(const Eigen::Vector3d& start_W, PlannedPath& plan);
/// Ends the plan on the ground. @param rest_z_m  height of the vehicle's origin there, in W
void add_landing(double rest_z_m, PlannedPath& plan);

}  // namespace vinerow::controllers
