#pragma once
/// Predicted state of a body in the middle of the coming step, from the change in the last step.
/// Forces that are computed there and held over the step (physics::ForceSampling::kHeld) make the
/// integration second order.

#include <Eigen/Core>

#include "engine/physics/physics_world.h"

namespace vinerow::vehicles {

/// q rotated by a small rotation vector in W.
inline Eigen::Quaterniond turned_on(const Eigen::Quaterniond& q,
                                    const Eigen::Vector3d& rotation_W) {
  Eigen::Quaterniond turn;
  turn.w() = 1.0;
  turn.vec() = 0.5 * rotation_W;
  return (turn * q).normalized();
}

class MidStep {
 public:
  /// Starts without knowledge of accelerations.
  void reset(const physics::BodyState& body) {
    body_ = before_ = body;
    acceleration_W_.setZero();
    spin_change_W_.setZero();
  }
  /// Records the state after a step.
  void take(const physics::BodyState& body, double dt_s) {
    before_ = body_;
    body_ = body;
    acceleration_W_ = (body_.v_WB_W - before_.v_WB_W) / dt_s;
    spin_change_W_ = (body_.w_WB_W - before_.w_WB_W) / dt_s;
  }

  const physics::BodyState& body() const { return body_; }
  /// State at the start of the last step.
  const physics::BodyState& before() const { return before_; }
  /// Mean over the last step.
  const Eigen::Vector3d& acceleration_W() const { return acceleration_W_; }

  /// State in the middle of the coming step.
  physics::BodyState middle(double dt_s) const {
    physics::BodyState middle;
    middle.v_WB_W = body_.v_WB_W + 0.5 * dt_s * acceleration_W_;
    middle.w_WB_W = body_.w_WB_W + 0.5 * dt_s * spin_change_W_;
    middle.X_WB.q = turned_on(body_.X_WB.q, 0.5 * dt_s * middle.w_WB_W);
    middle.X_WB.p = body_.X_WB.p + 0.5 * dt_s * body_.v_WB_W;
    return middle;
  }

 private:
  physics::BodyState body_, before_;
  Eigen::Vector3d acceleration_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d spin_change_W_ = Eigen::Vector3d::Zero();  // angular acceleration
};

}  // namespace vinerow::vehicles
