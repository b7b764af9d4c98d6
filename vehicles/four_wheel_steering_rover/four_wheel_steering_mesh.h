#pragma once
/// Meshes of paper A's rover for display: portal frame over the axles, battery tub, spray tank with
/// nozzle columns, GNSS mast, ultrasonic pods, and one steering knuckle with hub motor and mudguard
/// per wheel. The collision hull is in four_wheel_steering_rover.cpp.

#include "engine/api/mesh.h"
#include "vehicles/parts/chassis.h"

namespace vinerow::vehicles {

/// x forward, y left, z up, origin at B. Laid out for the default size and stretched with the
/// chassis.
TriangleMesh make_four_wheel_steering_body(const ChassisParams& params);

/// Knuckle, which steers with a wheel but does not spin; origin at the hub, kingpin along z.
TriangleMesh make_steering_knuckle(const ChassisParams& params, const Corner& corner);

}  // namespace vinerow::vehicles
