#pragma once
/// One dynamic body: state and load in double precision, next to Bullet's object. Only used in this
/// folder.

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <string>
#include <vector>

#include "engine/physics/free_motion.h"
#include "engine/physics/physics_world.h"

namespace vinerow::physics {

class Body {
 public:
  /// @throws ConfigError that names the body, the value and what is allowed
  Body(const BodySpec& spec, int index);

  const std::string& name() const { return name_; }
  const PrincipalInertia& inertia() const { return inertia_; }
  bool is_kinematic() const { return kinematic_; }
  /// Bullet's object, or null for a body without shapes.
  btRigidBody* bullet() { return bullet_.get(); }

  BodyState state() const;
  void set_state(const BodyState& state);
  void set_kinematic(bool kinematic);
  /// Fixes the body in place; other bodies collide with it as with a post.
  void set_held(bool held);

  void add_force(const Eigen::Vector3d& f_W, const Eigen::Vector3d& tau_W) {
    force_W_ += f_W;
    torque_W_ += tau_W;
  }
  const Eigen::Vector3d& position_W() const { return motion_.p_WP; }
  const Eigen::Vector3d& acceleration_W() const { return acceleration_W_; }

  /// Computes the step as if there were no contacts and passes pose (at its start) and velocities
  /// (at its end) to Bullet. Clears the added forces.
  void start_step(const Eigen::Vector3d& gravity_W, double dt_s);
  /// Sets the state at the end of the step: the contact-free one, or Bullet's if a contact pushed.
  /// @param contacts_solved  Bullet's solver ran
  void end_step(double dt_s, bool contacts_solved);

 private:
  void place_bullet(const MotionState& motion);

  std::string name_;
  PrincipalInertia inertia_;
  bool axes_are_principal_;
  bool kinematic_ = false;
  bool healthy_ = true;  ///< the state of the step is finite; otherwise it is not passed to Bullet
  ForceSampling sampling_;
  MotionState motion_;
  MotionState free_end_;
  HeldLoad load_, load_before_;
  bool has_load_before_ = false;
  Eigen::Vector3d force_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_W_ = Eigen::Vector3d::Zero();

  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::unique_ptr<btRigidBody> bullet_;
  btTransform placed_;  ///< transform passed to Bullet at the start of the step
};

}  // namespace vinerow::physics
