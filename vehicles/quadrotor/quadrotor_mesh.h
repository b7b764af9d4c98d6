#pragma once
/// Meshes of a quadrotor for display: carbon plates with a hood, arms with motors, legs with rubber
/// feet, battery in its sliding case, camera on a gimbal, GNSS mast. Collision shapes:
/// quadrotor_shapes.h.

#include "engine/api/mesh.h"
#include "vehicles/quadrotor/quadrotor_params.h"

namespace vinerow::vehicles {

/// x forward, y left, z up, origin at B. Laid out for the default size and stretched with it.
TriangleMesh make_quadrotor_body(const QuadrotorParams& params);

/// Two blades on a hub with a spinner; origin at the hub, z along the axis.
TriangleMesh make_quadrotor_rotor(double radius_m, bool counter_clockwise);

}  // namespace vinerow::vehicles
