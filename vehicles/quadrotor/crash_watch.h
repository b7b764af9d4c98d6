#pragma once
/// Judges what a quadrotor touches: it may stand on the ground on its feet, all else wrecks it.

#include <string>

#include "engine/physics/physics_world.h"
#include "vehicles/quadrotor/quadrotor_params.h"

namespace vinerow::vehicles {

/// @param before  state at the start of the step whose contacts are judged: what hit
/// @returns why the vehicle is wrecked, e.g. "hit the ground at 2.3 m/s"; empty if it is not. No
/// heap while it is not.
std::string judge_contacts(const physics::PhysicsWorld& world, physics::BodyId body,
                           const physics::BodyState& before, const QuadrotorParams& params);

/// The same for a foot that stands. @param body  state that brought it there
std::string judge_foot(const FootContact& contact, const physics::BodyState& body,
                       const QuadrotorParams& params);

}  // namespace vinerow::vehicles
