#pragma once
/// Collision shapes of a quadrotor (feet, body and rotor discs) for physics, canopy and outline.

#include "engine/api/vehicle.h"
#include "engine/physics/physics_world.h"
#include "vehicles/parts/foliage_watch.h"
#include "vehicles/quadrotor/quadrotor_params.h"

namespace vinerow::vehicles {

/// Half the thickness of a rotor's disc, including the coning of the blades.
constexpr double kDiscHalfHeight_m = 0.012;
/// Of the legs' rubber feet, for outline and display.
constexpr double kFootRadius_m = 0.012;

/// Body and legs (boxes) and rotor discs. parts/landing_foot.h models the feet, so that the box of
/// the legs ends above the ground.
std::vector<physics::PlacedShape> make_quadrotor_shapes(const QuadrotorParams& params);

/// Body, legs and rotor discs, for contacts with the canopy.
FoliageWatch make_foliage_watch(const QuadrotorParams& params);

/// Collision box and footprint: sixteen-cornered outline around the rotor discs.
void describe_outline(const QuadrotorParams& params, VehicleDescription& description);

/// True if a point of the hull belongs to the rotors, by its height.
/// @param z_B  m
bool is_at_rotors(const QuadrotorParams& params, double z_B);

}  // namespace vinerow::vehicles
