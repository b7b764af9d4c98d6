#include "engine/physics/body.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "engine/core/error.h"
#include "engine/physics/body_shape.h"
#include "engine/physics/bullet_convert.h"

// Plan of one step from t to t + dt, with x = (p, q, v, w) in motion_:
//
//   start_step   free_end_ = advance_free(x(t), load)      as if there were no contacts
//                Bullet gets the pose of x(t) and the velocities of free_end_
//   (solver)     changes these velocities so that contacts hold, and the pose to remove overlaps
//   end_step     x(t + dt) = free_end_                      if the solver changed nothing
//                x(t + dt) = advance_at_velocity(Bullet)    otherwise
//
// So a body without contacts keeps the accuracy of free_motion.h, and Bullet's first-order rule is
// used only where a contact pushed. All states are those of P, the principal axes at the centre of
// mass; state() and set_state() convert to B by q_BP.

namespace vinerow::physics {
namespace {

using Eigen::Vector3d;

/// Largest difference of mirrored entries, relative to the largest entry. Chosen: far above the
/// rounding of a sum of parts, far below a real asymmetry.
constexpr double kInertiaAsymmetry = 1e-9;
/// Largest deviation of a quaternion's norm from 1. Chosen: accepts numbers with seven digits.
constexpr double kNormError = 1e-6;

void check_spec(const BodySpec& spec) {
  const auto refuse = [&](const std::string& what) {
    throw ConfigError(fmt::format("body '{}': {}", spec.name, what));
  };
  if (!(spec.mass_kg > 0.0) || !std::isfinite(spec.mass_kg)) {
    refuse(fmt::format("mass_kg = {}, must be > 0", spec.mass_kg));
  }
  const double asymmetry = (spec.inertia_B - spec.inertia_B.transpose()).cwiseAbs().maxCoeff();
  if (!spec.inertia_B.allFinite() ||
      asymmetry > kInertiaAsymmetry * spec.inertia_B.cwiseAbs().maxCoeff() ||
      spec.inertia_B.llt().info() != Eigen::Success) {
    refuse("inertia_B must be symmetric and positive definite");
  }
  if (!spec.X_WB.p.allFinite() || !(std::abs(spec.X_WB.q.norm() - 1.0) < kNormError)) {
    refuse("X_WB must be finite with a unit quaternion");
  }
  if (!spec.v_WB_W.allFinite() || !spec.w_WB_W.allFinite()) refuse("velocities must be finite");
  if (!(spec.friction >= 0.0) || !std::isfinite(spec.friction)) {
    refuse(fmt::format("friction = {}, must be >= 0", spec.friction));
  }
  if (!(spec.restitution >= 0.0 && spec.restitution <= 1.0)) {
    refuse(fmt::format("restitution = {}, must be in 0..1", spec.restitution));
  }
}

}  // namespace

Body::Body(const BodySpec& spec, int index) : name_(spec.name), sampling_(spec.force_sampling) {
  check_spec(spec);
  inertia_ = PrincipalInertia::from_matrix(spec.mass_kg, spec.inertia_B);
  axes_are_principal_ = inertia_.q_BP.vec().isZero(0.0);
  shapes_ = make_body_shape(name_, spec.shapes, inertia_.q_BP);
  if (!shapes_.empty()) {
    btRigidBody::btRigidBodyConstructionInfo info(spec.mass_kg, nullptr, shapes_.back().get(),
                                                  to_bullet(inertia_.moments_kgm2));
    info.m_friction = spec.friction;
    info.m_restitution = spec.restitution;
    bullet_ = std::make_unique<btRigidBody>(info);
    bullet_->setActivationState(DISABLE_DEACTIVATION);
    bullet_->setFlags(0);  // without Bullet's gyroscopic term, which free_motion.h includes
    bullet_->setUserIndex2(index);
  }
  set_state({spec.X_WB, spec.v_WB_W, spec.w_WB_W});
}

BodyState Body::state() const {
  BodyState result;
  result.X_WB.p = motion_.p_WP;
  result.X_WB.q = axes_are_principal_ ? motion_.q_WP : motion_.q_WP * inertia_.q_BP.conjugate();
  result.v_WB_W = motion_.v_WP_W;
  result.w_WB_W = motion_.w_WP_W;
  return result;
}

void Body::set_state(const BodyState& state) {
  motion_.p_WP = state.X_WB.p;
  motion_.q_WP = axes_are_principal_ ? state.X_WB.q : state.X_WB.q * inertia_.q_BP;  // R_WB R_BP
  motion_.v_WP_W = state.v_WB_W;
  motion_.w_WP_W = state.w_WB_W;
  // The motion jumps: velocity Verlet must not correct with a load of before the jump.
  has_load_before_ = false;
  if (bullet_ && motion_.p_WP.allFinite() && motion_.q_WP.coeffs().allFinite()) {
    place_bullet(motion_);
  }
}

void Body::set_kinematic(bool kinematic) {
  kinematic_ = kinematic;
  has_load_before_ = false;
  if (!bullet_) return;
  const int flags = bullet_->getCollisionFlags();
  bullet_->setCollisionFlags(kinematic ? flags | btCollisionObject::CF_NO_CONTACT_RESPONSE
                                       : flags & ~btCollisionObject::CF_NO_CONTACT_RESPONSE);
}

void Body::set_held(bool held) {
  kinematic_ = held;
  motion_.v_WP_W.setZero();
  motion_.w_WP_W.setZero();
  has_load_before_ = false;
  if (!bullet_) return;
  bullet_->setLinearVelocity({0.0, 0.0, 0.0});
  bullet_->setAngularVelocity({0.0, 0.0, 0.0});
  // For the solver a body without mass is static.
  bullet_->setMassProps(held ? 0.0 : inertia_.mass_kg,
                        held ? btVector3(0, 0, 0) : to_bullet(inertia_.moments_kgm2));
  bullet_->updateInertiaTensor();
}

void Body::place_bullet(const MotionState& motion) {
  placed_ = btTransform(to_bullet(motion.q_WP), to_bullet(motion.p_WP));
  bullet_->setWorldTransform(placed_);
  bullet_->updateInertiaTensor();
}

void Body::start_step(const Vector3d& gravity_W, double dt_s) {
  // a = g + F / m, tau: the load of this step; forces count for one step only.
  load_.a_W = gravity_W + force_W_ / inertia_.mass_kg;
  load_.tau_W = torque_W_;
  force_W_.setZero();
  torque_W_.setZero();
  if (kinematic_) {
    healthy_ = motion_.p_WP.allFinite() && motion_.q_WP.coeffs().allFinite();
    if (bullet_ && healthy_) place_bullet(motion_);
    return;
  }
  // kSmooth: velocity Verlet with the load of the previous step. kHeld: constant load.
  const bool smooth = sampling_ == ForceSampling::kSmooth && has_load_before_;
  free_end_ = advance_free(motion_, inertia_, load_, smooth ? load_before_ : load_, dt_s);
  if (!bullet_) return;
  // NaN or infinity would break Bullet's indices and trees, and the bodies in contact. A body with
  // such a state keeps its last pose there, at rest.
  healthy_ = motion_.p_WP.allFinite() && motion_.q_WP.coeffs().allFinite() &&
             free_end_.v_WP_W.allFinite() && free_end_.w_WP_W.allFinite();
  if (!healthy_) {
    bullet_->setLinearVelocity({0.0, 0.0, 0.0});
    bullet_->setAngularVelocity({0.0, 0.0, 0.0});
  } else {
    place_bullet(motion_);
    bullet_->setLinearVelocity(to_bullet(free_end_.v_WP_W));
    bullet_->setAngularVelocity(to_bullet(free_end_.w_WP_W));
  }
}

void Body::end_step(double dt_s, bool contacts_solved) {
  if (kinematic_) {
    acceleration_W_.setZero();
    return;
  }
  load_before_ = load_;
  has_load_before_ = true;
  // Mean acceleration of the step: a without contacts, plus the solver's change of v over dt.
  acceleration_W_ = load_.a_W;
  if (bullet_ && contacts_solved && healthy_) {
    const Vector3d v_W = from_bullet(bullet_->getLinearVelocity());
    const Vector3d w_W = from_bullet(bullet_->getAngularVelocity());
    const bool moved = !(bullet_->getWorldTransform() == placed_);
    // The solver does not change a single bit of the velocities of an untouched body.
    if (moved || v_W != free_end_.v_WP_W || w_W != free_end_.w_WP_W) {
      acceleration_W_ += (v_W - free_end_.v_WP_W) / dt_s;
      if (moved) {  // the solver removed an overlap
        motion_.p_WP = from_bullet(bullet_->getWorldTransform().getOrigin());
        motion_.q_WP = from_bullet(bullet_->getWorldTransform().getRotation()).normalized();
      }
      // The end velocity moves the body, as in Bullet: a body at rest has zero velocity and does
      // not creep.
      motion_ = advance_at_velocity(motion_, v_W, w_W, dt_s);
      return;
    }
  }
  motion_ = free_end_;
}

}  // namespace vinerow::physics
