#include "vehicles/quadrotor/crash_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vehicles/parts/touch_judge.h"
#include "vehicles/quadrotor/quadrotor_shapes.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector3d;

/// Which part met something, for people.
const char* part_name(const QuadrotorParams& params, const Vector3d& p_B) {
  if (is_at_rotors(params, p_B.z())) return "a rotor";
  return p_B.z() < -0.5 * params.stand_height_m ? "its landing gear" : "its body";
}

std::string judge_ground(const QuadrotorParams& params, const Vector3d& p_B, double tilt_rad,
                         double speed_mps) {
  if (speed_mps > params.landing_speed_limit_mps) {
    return fmt::format("hit the ground at {:.1f} m/s", speed_mps);
  }
  if (is_at_rotors(params, p_B.z())) {
    return fmt::format("touched the ground with a rotor at {:.1f} m/s", speed_mps);
  }
  if (tilt_rad > params.landing_tilt_limit_rad) {
    return fmt::format("touched the ground tilted by {:.0f} deg", deg_from_rad(tilt_rad));
  }
  return {};
}

}  // namespace

double calc_tilt_rad(const Eigen::Quaterniond& q_WB) {
  return std::acos(std::clamp((q_WB * Vector3d::UnitZ()).z(), -1.0, 1.0));
}

std::string judge_contacts(const physics::PhysicsWorld& world, physics::BodyId body,
                           const physics::BodyState& before, const QuadrotorParams& params) {
  return judge_touches(
      world, body, before, [&](const Vector3d& p_B) { return part_name(params, p_B); },
      [&](const GroundTouch& touch) {
        return judge_ground(params, touch.p_B, calc_tilt_rad(before.X_WB.q), touch.speed_mps);
      });
}

std::string find_crash_at_foot(const FootContact& contact, const physics::BodyState& body,
                               const QuadrotorParams& params) {
  const double speed_mps = body.v_WB_W.norm();
  if (contact.surface != SurfaceClass::kTerrain) {
    return fmt::format("hit {} with its landing gear at {:.1f} m/s", to_string(contact.surface),
                       speed_mps);
  }
  return judge_ground(params, Vector3d(0.0, 0.0, -params.stand_height_m),
                      calc_tilt_rad(body.X_WB.q), speed_mps);
}

}  // namespace vinerow::vehicles
