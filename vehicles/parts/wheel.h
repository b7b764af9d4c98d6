#pragma once
/// Wheel of a vehicle: strut, tyre, spin, motor, brake and steering angle. Skid-steered,
/// four-wheel-steered and free wheels all use this model.
///
/// The mass of the wheel belongs to the vehicle's rigid body (the wheel's heave relative to the
/// body is no state); its spin is a state. One step solves, implicitly in the new spin omega,
///
///   I domega/dt = tau_motor(omega) - R F_x(omega) - Coulomb(c_rr N R + tau_brake).
///
/// The Coulomb torque holds omega = 0 exactly within its limit: a braked wheel does not turn.
///
/// Frames: A wheel axes (x forward, y axle to the left, z strut up), C contact frame of tyre.h.
/// Signs: spin is positive when the vehicle rolls forward; steering is positive to the left.
/// Cost: no heap; about 130 ns per step without the rays.

#include <Eigen/Core>
#include <string>

#include "engine/math/pose.h"
#include "vehicles/parts/motor.h"
#include "vehicles/parts/suspension.h"
#include "vehicles/parts/tyre.h"
#include "vehicles/parts/wheel_contact.h"

namespace vinerow::vehicles {

struct WheelParams {
  std::string name = "fl";                          ///< in signals: "wheel_<name>_..."
  Eigen::Vector3d hub_B = Eigen::Vector3d::Zero();  ///< centre in its design position, m
  double radius_m = 0.2;                            ///< > 0
  double spin_inertia_kgm2 = 0.2;  ///< I about the axle, gear and rotor included, > 0
  int probes = 3;                  ///< rays per step: 1 (smooth ground) or 3
  TyreParams tyre;
  SuspensionParams suspension;
  MotorParams motor;

  /// @throws ConfigError
  void validate(const std::string& who) const;
};

struct WheelState {
  double spin_radps = 0.0;  ///< relative to the body
  double angle_rad = 0.0;   ///< integral of the spin, wrapped to (-pi, pi], for display
  double steer_rad = 0.0;   ///< of the axle about the strut
  double travel_m = 0.0;    ///< of the hub, positive in compression
  TyreState tyre;
  MotorState motor;
};

/// Forces and velocities of a wheel in the last step.
struct WheelOutput {
  bool touches = false;
  double load_N = 0.0;         ///< along the ground's normal
  double force_x_N = 0.0;      ///< of the ground on the wheel, rolling direction
  double force_y_N = 0.0;      ///< to the left
  double v_x_mps = 0.0;        ///< of the vehicle at the contact point, rolling direction
  double v_y_mps = 0.0;        ///< to the left
  double rim_speed_mps = 0.0;  ///< R omega
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();            ///< contact point
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();        ///< of the ground, at p_W
  Eigen::Vector3d body_torque_W = Eigen::Vector3d::Zero();  ///< added to the moment of force_W

  /// (R omega - v_x) / max(|R omega|, |v_x|); 0 at rest, where slip has no meaning.
  double slip() const;
  /// atan2(v_y, |v_x|); 0 at rest.
  double slip_angle_rad() const;
};

class Wheel {
 public:
  /// @throws ConfigError
  Wheel(const WheelParams& params, const std::string& who);

  /// Disc in the world, for find_wheel_contact. @param R_WB  rotation matrix of the body
  WheelDisc disc(const WheelState& state, const Eigen::Vector3d& p_WB,
                 const Eigen::Matrix3d& R_WB) const;

  /// Advances `state` by one step. @param command_radps  commanded spin
  /// @param v_W,w_W  velocity of the body's origin and angular velocity of the body
  WheelOutput step(const WheelDisc& disc, const WheelContact& contact, const Eigen::Vector3d& p_WB,
                   const Eigen::Vector3d& v_W, const Eigen::Vector3d& w_W, const Soil& soil,
                   double command_radps, double dt_s, WheelState& state) const;

  /// Pose in B of the wheel's link, with steering, spring travel and spin angle.
  Pose link_pose_B(const WheelState& state) const;

  const WheelParams& params() const { return params_; }

 private:
  WheelParams params_;
  Tyre tyre_;
  Motor motor_;
};

}  // namespace vinerow::vehicles
