#pragma once
/// Launch by hand or catapult: holds the vehicle, then accelerates it evenly along a straight path.
/// The push takes a whole number of steps, so that its length is off by at most the distance of one
/// step.

#include "engine/physics/physics_world.h"
#include "vehicles/fixed_wing/fixed_wing_params.h"

namespace vinerow::vehicles {

class Launcher {
 public:
  /// Releases the vehicle: a start in the air.
  void release() { phase_ = Phase::kFree; }
  /// @param ground_W  ground below the launcher  @param yaw_rad  direction of the launch
  void hold(const LaunchParams& params, const Eigen::Vector3d& ground_W, double yaw_rad);

  bool holds() const { return phase_ != Phase::kFree; }
  /// Starts the push. @pre holds()
  void push(double dt_s);
  bool is_pushing() const { return phase_ == Phase::kPush; }

  /// Advances by one step. @returns the state at its end. @pre holds()
  const physics::BodyState& advance();
  const physics::BodyState& state() const { return state_; }
  /// During the push, else zero.
  const Eigen::Vector3d& acceleration_W() const { return acceleration_W_; }

 private:
  enum class Phase { kWait, kPush, kFree };
  Phase phase_ = Phase::kFree;
  double speed_mps_ = 0.0, length_m_ = 0.0, step_s_ = 0.0;
  long steps_ = 0, step_ = 0;
  Eigen::Vector3d start_W_ = Eigen::Vector3d::Zero(), along_W_ = Eigen::Vector3d::UnitX();
  Eigen::Vector3d acceleration_W_ = Eigen::Vector3d::Zero();
  physics::BodyState state_;
};

}  // namespace vinerow::vehicles
