#pragma once
/// Lays a rotorcraft down onto all its feet after a landing, held by its rotors until the ground
/// carries it.
///
/// On a slope it stands on its uphill foot, level, and its rotors hold the rest. Left to itself it
/// falls over that foot, faster and faster, and rolls on over the downhill feet. So its rotors hold
/// what they held, and give way at a rate: a rate controller about a held torque, tau = S - D w,
/// dS/dt = -K w, while |S| falls by K w_lay. A fall slower than w_lay is helped on, a faster one is
/// braked; a vehicle that lies does not turn, and its rotors fall silent. Where the slope leads
/// down need not be known. The flight law's own torque plays no part: its integrators and observers
/// take the ground's push for wind.

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

  /// @param held  what the rotors made when it had landed
  void start(const Wrench& held) {
    held_ = held;
    held_.torque_B.z() = 0.0;
    thrust_N_ = held.thrust_N;
  }
  /// What to ask for now. @param rates_B  of the vehicle, rad/s
  Wrench advance(const Eigen::Vector3d& rates_B, double dt_s) {
    const Eigen::Vector3d falling_B(rates_B.x(), rates_B.y(), 0.0);
    const double hold_Nm = kHold_per_s2 * inertia_kgm2_;  // per rad
    held_.torque_B -= hold_Nm * dt_s * falling_B;
    const double torque_Nm = held_.torque_B.norm(), less_Nm = hold_Nm * kLay_radps * dt_s;
    held_.torque_B *= torque_Nm > less_Nm ? 1.0 - less_Nm / torque_Nm : 0.0;
    held_.thrust_N = std::max(0.0, held_.thrust_N - thrust_N_ * dt_s / kGrip_s);
    return {held_.thrust_N, held_.torque_B - kBrake_per_s * inertia_kgm2_ * falling_B};
  }
  /// The share of what was asked for that was too much for the rotors, or for most_thrust_N().
  void limit(double share) { held_.torque_B *= share; }
  /// More would take the grip from the feet on the ground.
  double most_thrust_N() const { return std::max(held_.thrust_N, kMostLift * weight_N_); }

 private:
  /// w_lay: 21 deg of slope take a second.
  static constexpr double kLay_radps = 0.35;
  /// K and D over the inertia: an oscillator of 5.5 rad/s, damped by 0.41. So fast a vehicle of the
  /// Q4T's size falls over its foot: sqrt(m g l / I) = 5.1 rad/s.
  static constexpr double kHold_per_s2 = 30.0, kBrake_per_s = 4.5;
  /// Within this time rotors hold no more than torques take: carried by them for long it slides.
  static constexpr double kGrip_s = 0.5;
  /// Of the weight. With a friction of 0.8 feet hold on 21 deg of slope while rotors carry less
  /// than cos(s) - sin(s) / 0.8 = 0.49 of it.
  static constexpr double kMostLift = 0.5;

  double inertia_kgm2_ = 0.0, weight_N_ = 0.0;
  double thrust_N_ = 0.0;  // at the start
  Wrench held_;
};

}  // namespace vinerow::controllers
