#pragma once
/// Motion of a rigid body without contacts over one step, more accurate than Bullet's first-order
/// rule.
///
/// Translation: exact for a constant acceleration. Rotation: the state is the angular momentum H
/// about the centre of mass in W. Only the torque changes it (H(t) = H_0 + tau t), so |H| of a free
/// body is constant to rounding. The attitude follows from
///   dq/dt = 1/2 q (0, w),   w = I^-1 R(q)^T H(t)   (principal axes)
/// by the classical Runge-Kutta rule, fourth order in the step.
///
/// Frames: P is at the centre of mass, axes along the principal axes of inertia.
/// Cost: about 0.1 us, no heap, no state, thread safe.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace vinerow::physics {

/// Mass properties in principal axes.
struct PrincipalInertia {
  double mass_kg = 1.0;
  Eigen::Vector3d moments_kgm2 = Eigen::Vector3d::Ones();    ///< diagonal of I_P
  Eigen::Quaterniond q_BP = Eigen::Quaterniond::Identity();  ///< principal axes in the body
  Eigen::Vector3d inverse_moments_per_kgm2 = Eigen::Vector3d::Ones();

  /// @param inertia_B  symmetric, positive definite, about the centre of mass, kg m2; a diagonal
  /// matrix keeps its axes (q_BP is then exactly the identity)
  static PrincipalInertia from_matrix(double mass_kg, const Eigen::Matrix3d& inertia_B);
};

struct MotionState {
  Eigen::Vector3d p_WP = Eigen::Vector3d::Zero();  ///< m
  Eigen::Quaterniond q_WP = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WP_W = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d w_WP_W = Eigen::Vector3d::Zero();  ///< rad/s
};

/// Load on the body, constant over the step.
struct HeldLoad {
  Eigen::Vector3d a_W = Eigen::Vector3d::Zero();    ///< acceleration of the centre of mass, m/s2
  Eigen::Vector3d tau_W = Eigen::Vector3d::Zero();  ///< torque about the centre of mass, N m
};

/// Angular momentum about the centre of mass in W, N m s.
Eigen::Vector3d calc_angular_momentum_W(const MotionState& state, const PrincipalInertia& inertia);

/// State after dt_s under a constant load.
/// @param load_before  load of the previous step. If it equals `load`, the load is held over the
/// step. Otherwise the velocities first get 1/2 dt (load - load_before), which makes the sequence
/// of steps velocity Verlet: second order for loads that depend on position (no energy drift in
/// springs) and on velocity, with one evaluation of the load per step. Source: Groot, Warren,
/// "Dissipative particle dynamics", J. Chem. Phys. 107 (1997), the modified velocity Verlet with
/// lambda = 1.
MotionState advance_free(const MotionState& start, const PrincipalInertia& inertia,
                         const HeldLoad& load, const HeldLoad& load_before, double dt_s);

/// State after dt_s at the constant velocities v_W and w_W, from the pose of `pose`: Bullet's own
/// rule, used in steps in which a contact pushed.
MotionState advance_at_velocity(const MotionState& pose, const Eigen::Vector3d& v_W,
                                const Eigen::Vector3d& w_W, double dt_s);

}  // namespace vinerow::physics
