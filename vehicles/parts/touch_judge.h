#pragma once
/// Judgement of a flying vehicle's contacts in the last step: one sentence if they wreck it.
/// Contacts with vehicles, posts, trunks and obstacles always do; the vehicle judges contacts with
/// the ground.

#include <fmt/format.h>

#include <string>

#include "engine/physics/physics_world.h"

namespace vinerow::vehicles {

/// Contact with the ground.
struct GroundTouch {
  Eigen::Vector3d p_B;       ///< of the hull
  Eigen::Vector3d normal_W;  ///< of the ground, unit
  double speed_mps = 0.0;    ///< of that point
  double sink_mps = 0.0;     ///< its component into the ground
};

/// @param before  state at the start of the step, with the velocities of the impact
/// @param part_name  (p_B) -> text such as "a rotor"
/// @param judge_ground  (GroundTouch) -> reason, empty where it may touch like that
/// @returns why the vehicle is wrecked; empty if it is not. No heap while it is not.
template <class PartName, class JudgeGround>
std::string judge_touches(const physics::PhysicsWorld& world, physics::BodyId body,
                          const physics::BodyState& before, const PartName& part_name,
                          const JudgeGround& judge_ground) {
  for (const physics::Contact& contact : world.contacts()) {
    const bool mine = contact.body.index == body.index;
    if (!mine && contact.other.index != body.index) continue;
    const Eigen::Vector3d arm_W = contact.p_W - before.X_WB.p;
    const Eigen::Vector3d p_B = before.X_WB.q.conjugate() * arm_W;
    const Eigen::Vector3d v_W = before.v_WB_W + before.w_WB_W.cross(arm_W);
    if (contact.other.index >= 0) {
      const physics::BodyId other = mine ? contact.other : contact.body;
      return fmt::format("hit {} with {} at {:.1f} m/s", world.body_name(other), part_name(p_B),
                         v_W.norm());
    }
    if (contact.surface != SurfaceClass::kTerrain) {
      return fmt::format("hit {} '{}' with {} at {:.1f} m/s", to_string(contact.surface),
                         world.contact_name(contact), part_name(p_B), v_W.norm());
    }
    std::string reason =
        judge_ground(GroundTouch{p_B, contact.normal_W, v_W.norm(), -v_W.dot(contact.normal_W)});
    if (!reason.empty()) return reason;
  }
  return {};
}

}  // namespace vinerow::vehicles
