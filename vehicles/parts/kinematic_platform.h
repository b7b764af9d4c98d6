#pragma once
/// Kinematic vehicle body: it moves on the ground exactly as its kinematic model, without forces.
///
/// The horizontal pose follows planar_motion.h, independent of the ground. Height and tilt follow
/// the plane through the ground under the wheels. Collision shapes report contacts and push
/// nothing.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "engine/physics/physics_world.h"
#include "vehicles/parts/planar_motion.h"

namespace vinerow::vehicles {

struct KinematicPlatformParams {
  std::string name;
  double mass_kg = 1.0;  ///< of the body in the physics world, and for the energy
  Eigen::Matrix3d inertia_B = Eigen::Matrix3d::Identity();
  std::vector<physics::PlacedShape> shapes;
  double track_m = 1.0;
  double wheel_base_m = 1.0;
  double height_above_ground_m = 0.0;  ///< of B's origin
};

struct KinematicPlatformState {
  PlanarState planar;
  physics::BodyState body;
  Eigen::Vector3d specific_force_B = Eigen::Vector3d::Zero();
  double climb_rate_mps = 0.0;
};

class KinematicPlatform {
 public:
  /// @throws ConfigError
  explicit KinematicPlatform(KinematicPlatformParams params);

  void spawn(physics::PhysicsWorld& world, const Pose& X_WB);
  /// Sets the rim speeds of both sides, m/s, until the next call.
  void command(double left_mps, double right_mps);
  /// Moves along the arc of one step and places the body.
  void before_physics(Duration dt);
  void read_truth(Odometry& truth) const;

  const KinematicPlatformState& state() const { return state_; }
  physics::BodyId body() const { return body_; }

 private:
  void place_on_ground(double dt_s);

  KinematicPlatformParams params_;
  KinematicPlatformState state_;
  physics::PhysicsWorld* world_ = nullptr;
  physics::BodyId body_;
};

}  // namespace vinerow::vehicles
