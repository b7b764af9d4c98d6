#include "engine/physics/free_motion.h"

#include <cmath>

#include "engine/math/decomposition.h"

// Equations. H is the angular momentum about the centre of mass, in W; q = q_WP with rotation R;
// I the principal moments; a and tau the load of the step.
//
//   dp/dt = v,   dv/dt = a                        p1 = p0 + dt v + dt^2 / 2 a,   v1 = v + dt a
//   dH/dt = tau                                   h_mid = h0 + dt / 2 tau,       h1 = h0 + dt tau
//   dq/dt = f(q, H) = 1/2 q (0, w_P),  w_P = I^-1 R^T H
//
// Velocity Verlet needs the mean of the loads at both ends of a step, but the load at its end is
// known only in the next step. Each step therefore first corrects the velocities of the previous
// one by half of the change:
//   v = v0 + dt / 2 (a - a_before),               h0 = H(t) + dt / 2 (tau - tau_before)
//
// Attitude, Runge-Kutta of order 4:
//   k1 = f(q0, h0)                                k2 = f(q0 + dt / 2 k1, h_mid)
//   k3 = f(q0 + dt / 2 k2, h_mid)                 k4 = f(q0 + dt k3, h1)
//   q1 = q0 + dt / 6 (k1 + 2 k2 + 2 k3 + k4), normalised
//   w1 = R1 I^-1 R1^T h1

namespace vinerow::physics {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// f(q, H) = dq/dt. q need not be unit: f is smooth off the unit sphere too, as the order of the
/// rule requires.
Quaterniond calc_rate(const Quaterniond& q, const Vector3d& momentum_W,
                      const Vector3d& inverse_moments) {
  const Vector3d u = q.vec();
  // R^T H written out: H + 2 w (H x u) + 2 (H x u) x u, with q = (w, u).
  const Vector3d cross = momentum_W.cross(u);
  const Vector3d momentum_P = momentum_W + 2.0 * (q.w() * cross + cross.cross(u));
  const Vector3d w_P = inverse_moments.cwiseProduct(momentum_P);
  Quaterniond rate;
  rate.w() = -0.5 * u.dot(w_P);
  rate.vec() = 0.5 * (q.w() * w_P + u.cross(w_P));
  return rate;
}

/// q + factor * rate, not normalised.
Quaterniond add_scaled(const Quaterniond& q, double factor, const Quaterniond& rate) {
  Quaterniond sum;
  sum.coeffs() = q.coeffs() + factor * rate.coeffs();
  return sum;
}

/// w = R I^-1 R^T H.
Vector3d calc_rate_W(const Quaterniond& q, const Vector3d& momentum_W,
                     const Vector3d& inverse_moments) {
  return q * inverse_moments.cwiseProduct(q.conjugate() * momentum_W);
}

}  // namespace

PrincipalInertia PrincipalInertia::from_matrix(double mass_kg, const Eigen::Matrix3d& inertia_B) {
  PrincipalInertia result;
  result.mass_kg = mass_kg;
  if (inertia_B.isDiagonal(0.0)) {
    result.moments_kgm2 = inertia_B.diagonal();
  } else {
    const SymmetricEigen<3> principal = decompose_symmetric<3>(inertia_B);
    Eigen::Matrix3d R_BP = principal.vectors;
    // Eigenvectors may form a left-handed frame; the opposite of an axis is principal too.
    if (R_BP.determinant() < 0.0) R_BP.col(0) = -R_BP.col(0);
    result.moments_kgm2 = principal.values;
    result.q_BP = Quaterniond(R_BP).normalized();
  }
  result.inverse_moments_per_kgm2 = result.moments_kgm2.cwiseInverse();
  return result;
}

Vector3d calc_angular_momentum_W(const MotionState& state, const PrincipalInertia& inertia) {
  return state.q_WP * inertia.moments_kgm2.cwiseProduct(state.q_WP.conjugate() * state.w_WP_W);
}

MotionState advance_free(const MotionState& start, const PrincipalInertia& inertia,
                         const HeldLoad& load, const HeldLoad& load_before, double dt_s) {
  MotionState end;
  // Translation, with the Verlet correction of the start velocity.
  const Vector3d v_W = start.v_WP_W + (0.5 * dt_s) * (load.a_W - load_before.a_W);
  end.p_WP = start.p_WP + dt_s * v_W + (0.5 * dt_s * dt_s) * load.a_W;
  end.v_WP_W = v_W + dt_s * load.a_W;

  // Angular momentum at the start (corrected likewise), in the middle and at the end.
  const Vector3d& inverse = inertia.inverse_moments_per_kgm2;
  const Vector3d h0_W =
      calc_angular_momentum_W(start, inertia) + (0.5 * dt_s) * (load.tau_W - load_before.tau_W);
  const Vector3d h_mid_W = h0_W + (0.5 * dt_s) * load.tau_W;
  const Vector3d h1_W = h0_W + dt_s * load.tau_W;
  // Attitude by Runge-Kutta.
  const Quaterniond& q0 = start.q_WP;
  const Quaterniond k1 = calc_rate(q0, h0_W, inverse);
  const Quaterniond k2 = calc_rate(add_scaled(q0, 0.5 * dt_s, k1), h_mid_W, inverse);
  const Quaterniond k3 = calc_rate(add_scaled(q0, 0.5 * dt_s, k2), h_mid_W, inverse);
  const Quaterniond k4 = calc_rate(add_scaled(q0, dt_s, k3), h1_W, inverse);
  end.q_WP.coeffs() = q0.coeffs() + (dt_s / 6.0) * (k1.coeffs() + 2.0 * k2.coeffs() +
                                                    2.0 * k3.coeffs() + k4.coeffs());
  end.q_WP.normalize();
  end.w_WP_W = calc_rate_W(end.q_WP, h1_W, inverse);
  return end;
}

MotionState advance_at_velocity(const MotionState& pose, const Vector3d& v_W, const Vector3d& w_W,
                                double dt_s) {
  // p1 = p0 + dt v,  q1 = (cos(x / 2), sin(x / 2) w / |w|) q0 with the angle x = |w| dt.
  MotionState end;
  end.v_WP_W = v_W;
  end.w_WP_W = w_W;
  end.p_WP = pose.p_WP + dt_s * v_W;
  const double angle_rad = w_W.norm() * dt_s;
  // sin(x / 2) / x = 1/2 - x^2 / 48 + x^4 / 3840 ... near zero, where the quotient is 0 / 0. The
  // neglected term is below 3e-20 there.
  constexpr double kSmallAngle_rad = 1e-4;
  const double half_sinc = angle_rad < kSmallAngle_rad ? 0.5 - angle_rad * angle_rad / 48.0
                                                       : std::sin(0.5 * angle_rad) / angle_rad;
  Quaterniond turn;
  turn.w() = std::cos(0.5 * angle_rad);
  turn.vec() = (half_sinc * dt_s) * w_W;
  end.q_WP = (turn * pose.q_WP).normalized();
  return end;
}

}  // namespace vinerow::physics
