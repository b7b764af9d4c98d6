#pragma once
/// What of a quadrotor touches: feet, body and rotor discs, for the physics, for the leaves and as
/// an outline for planners.

#include "engine/api/vehicle.h"
#include "engine/physics/physics_world.h"
#include "vehicles/parts/foliage_watch.h"
#include "vehicles/quadrotor/quadrotor_params.h"

namespace vinerow::vehicles {

/// Half the thickness of a rotor's disc: the blades' height and what they cone.
constexpr double kDiscHalfHeight_m = 0.012;
/// Of the legs' rubber feet, for the outline and for pictures.
constexpr double kFootRadius_m = 0.012;

/// Body and legs (boxes) and rotor discs. The feet themselves stand by parts/landing_foot.h: the
/// box of the legs ends above the ground.
std::vector<physics::PlacedShape> make_quadrotor_shapes(const QuadrotorParams& params);

/// Body, legs and rotor discs for the leaves.
FoliageWatch make_foliage_watch(const QuadrotorParams& params);

/// Collision box and footprint: sixteen-cornered outline around the rotor discs.
void describe_outline(const QuadrotorParams& params, VehicleDescription& description);

/// Which part a point of the hull belongs to, by its height.
/// @param z_B  m
bool is_at_rotors(const QuadrotorParams& params, double z_B);

}  // namespace vinerow::vehicles
