#pragma once
/// Paper A's rover as drawn: portal frame over the axles, battery tub, spray tank with nozzle
/// columns, GNSS mast, ultrasonic pods, and one steering knuckle with hub motor and mudguard per
/// wheel. Decoration only; the hull that collides is in four_wheel_steering_rover.cpp.

#include "engine/api/mesh.h"
#include "vehicles/parts/chassis.h"

namespace vinerow::vehicles {

struct FourWheelSteeringMeshParams {
  double wheel_base_m = 1.5;
  double track_m = 0.85;
  double wheel_radius_m = 0.2;
  double tyre_width_m = 0.15;
  double ground_to_origin_m = 0.42;  ///< height of the body mesh's origin above level ground
};

/// x forward, y left, z up, origin at B.
TriangleMesh make_four_wheel_steering_body(const FourWheelSteeringMeshParams& params);

/// What steers with a wheel and does not turn with it; origin at the hub, kingpin along z.
TriangleMesh make_steering_knuckle(const FourWheelSteeringMeshParams& params, const Corner& corner);

}  // namespace vinerow::vehicles
