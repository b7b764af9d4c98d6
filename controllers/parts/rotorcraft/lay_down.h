#pragma once
/// Controller that lays a rotorcraft down onto all its feet after a landing; the rotors support it
/// until the ground does.
///
/// On a slope it first stands level on its uphill foot, and the rotors carry the rest. Without
/// control it would tip over that foot, faster and faster, and roll on over the downhill feet. So
/// the rotors keep their wrench and reduce it gradually: a rate controller about a held torque,
/// tau = S - D w, dS/dt = -K w, while |S| falls by K w_lay. A rotation slower than w_lay is
/// accelerated, a faster one is braked; when the vehicle lies on the ground it does not rotate, and
/// the torque decays to zero. The direction of the slope need not be known. The flight law's own
/// torque is not used: its integrators and observers would take the ground's force for wind.

#include <Eigen/Core>
#include <algorithm>

#include "controllers/parts/rotorcraft/rotor_mixer.h"

namespace vinerow::controllers {

class LayDown {
 public:
  LayDown() = default;
  /// @param inertia_kgm2  of the vehicle about a foot
  LayDown(double inertia_kgm2, double weight_N)
      : inertia_kgm2_(inertia_kgm2), weight_N_(weight_N) {}

  /// @param held  wrench of the rotors at the time of landing
  void start(const Wrench& held) {
    held_ = held;
    held_.torque_B.z() = 0.0;
    thrust_N_ = held.thrust_N;
  }
  /// The wrench to command now. @param rates_B  of the vehicle, rad/s
  Wrench advance(const Eigen::Vector3d& rates_B, double dt_s) {
    const Eigen::Vector3d falling_B(rates_B.x(), rates_B.y(), 0.0);
    const double hold_Nm = kHold_per_s2 * inertia_kgm2_;  // per rad
    held_.torque_B -= hold_Nm * dt_s * falling_B;
    const double torque_Nm = held_.torque_B.norm(), less_Nm = hold_Nm * kLay_radps * dt_s;
    held_.torque_B *= torque_Nm > less_Nm ? 1.0 - less_Nm / torque_Nm : 0.0;
    held_.thrust_N = std::max(0.0, held_.thrust_N - thrust_N_ * dt_s / kGrip_s);
    return {held_.thrust_N, held_.torque_B - kBrake_per_s * inertia_kgm2_ * falling_B};
  }
  /// Reduces the held torque to the share that the rotors, or max_thrust_N(), allow.
  void limit(double share) { held_.torque_B *= share; }
  /// Largest thrust that leaves the feet their grip on the ground.
  double max_thrust_N() const { return std::max(held_.thrust_N, kMaxLift * weight_N_); }

 private:
  /// w_lay: a slope of 21 deg takes a second.
  static constexpr double kLay_radps = 0.35;
  /// K and D over the inertia: an oscillator of 5.5 rad/s with damping 0.41. A vehicle of the Q4T's
  /// size tips over its foot at a similar rate: sqrt(m g l / I) = 5.1 rad/s.
  static constexpr double kHold_per_s2 = 30.0, kBrake_per_s = 4.5;
  /// Within this time the thrust falls to what the torques need: a vehicle carried for long slides.
  static constexpr double kGrip_s = 0.5;
  /// Of the weight. With a friction of 0.8 the feet hold on a slope of 21 deg while the rotors
  /// carry less than cos(s) - sin(s) / 0.8 = 0.49 of it.
  static constexpr double kMaxLift = 0.5;

  double inertia_kgm2_ = 0.0, weight_N_ = 0.0;
  double thrust_N_ = 0.0;  // at the start
  Wrench held_;
};

}  // namespace vinerow::controllers
