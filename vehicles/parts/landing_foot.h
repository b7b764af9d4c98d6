#pragma once
/// Foot of a landing gear: a leg with spring and damper along the body's z axis, and a rubber foot
/// with static friction.
///
/// Normal force: S = max(0, k (d + d_0) + c dd/dt), with the depth d of the ground above the foot
/// as drawn and d_0 = static load / k, so that the vehicle rests as drawn. Friction: a spring holds
/// the rubber at an anchor on the ground (Haessig, Friedland, J. Dyn. Sys. Meas. Control 113(3),
/// 1991, "bristle"); if it would pull harder than mu N, the anchor is dragged along. A vehicle at
/// rest therefore stays in place, without creep, on any slope on which the rubber holds.

#include <Eigen/Core>
#include <optional>

#include "engine/api/parameter_table_fwd.h"
#include "engine/physics/physics_world.h"

namespace vinerow::vehicles {

struct LandingFootParams {
  double stiffness_N_per_m = 5000.0;
  double damping_Ns_per_m = 50.0;
  double friction = 0.8;
  double static_load_N = 5.0;
  /// Height above the foot from which the ground is searched; deeper ground is not found.
  double leg_m = 0.10;

  /// @throws ConfigError
  void validate(const std::string& who) const;
};

/// gear_stiffness_N_per_m, gear_damping_Ns_per_m, gear_friction
const ParameterTable<LandingFootParams>& landing_foot_table();

struct LandingFootState {
  bool stands = false;
  Eigen::Vector3d anchor_W = Eigen::Vector3d::Zero();  ///< valid while it stands
};

/// Contact of a foot in one step.
struct FootContact {
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< point of action
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  SurfaceClass surface = SurfaceClass::kTerrain;
};

/// @param foot_B  lowest point of the foot as drawn
/// @returns null if the foot is in the air. No heap.
std::optional<FootContact> press_foot(const LandingFootParams& params,
                                      const physics::PhysicsWorld& world,
                                      const physics::BodyState& body, const Eigen::Vector3d& foot_B,
                                      LandingFootState& state);

}  // namespace vinerow::vehicles
