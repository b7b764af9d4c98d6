#pragma once
/// Judgement of a quadrotor's contacts: it may stand on the ground on its feet; any other contact
/// wrecks it.

#include <string>

#include "engine/physics/physics_world.h"
#include "vehicles/quadrotor/quadrotor_params.h"

namespace vinerow::vehicles {

/// Angle between the body's z axis and the vertical, 0 to pi.
double calc_tilt_rad(const Eigen::Quaterniond& q_WB);

/// @param before  state at the start of the step, with the velocities of the impact
/// @returns the reason for a wreck, e.g. "hit the ground at 2.3 m/s"; empty without a wreck,
/// and then no heap
std::string judge_contacts(const physics::PhysicsWorld& world, physics::BodyId body,
                           const physics::BodyState& before, const QuadrotorParams& params);

/// The same for a foot on the ground. @param body  state before the contact
std::string find_crash_at_foot(const FootContact& contact, const physics::BodyState& body,
                               const QuadrotorParams& params);

}  // namespace vinerow::vehicles
