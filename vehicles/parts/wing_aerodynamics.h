#pragma once
/// Aerodynamics of a whole aircraft by coefficients, as a pure function of air velocity, rates,
/// density and elevons. Source: Beard, McLain, *Small Unmanned Aircraft*, 2012, chapter 4, with
/// these differences: nothing is divided by the airspeed, so that a body at rest in the air is no
/// special case; side slip enters as sin(beta) = v / V; each elevon adds the drag of its
/// deflection.
///
/// The coefficients use the axes of aviation: x forward, y right, z down; u, v, w through the air,
/// p, q, r. d_e = (right + left) / 2, d_a = (left - right) / 2, trailing edge down > 0: d_e > 0
/// pitches down, d_a > 0 rolls right. With alpha = atan2(w, u), s(alpha) the stalled share (eq.
/// 4.10) and k = 1 - s (1 - stalled_control):
///   C_L = (1 - s) (C_L0 + C_La alpha) + s 2 sign(alpha) sin^2 cos + C_Lq c q / 2V + k C_Lde d_e
///   C_D = C_D0 + (1 - s) C_L^2 / (pi e AR) + s 2 |sin|^3 + C_Dd2 mean(elevon^2)
///   C_m = (1 - s) (C_m0 + C_ma alpha) - s arm 2 sign sin^2 + C_mq c q / 2V + k C_mde d_e
///   C_Y, C_l, C_n: linear in sin(beta), p b / 2V, r b / 2V, and k d_a
/// A plate's normal force 2 sin^2 acts `plate_arm` chords behind the centre of mass. Lift, drag and
/// C_m act in the plane of symmetry, with V sqrt(u^2 + w^2) in place of V^2.
///
/// Left out are spin (C_lp keeps its sign in a stall), compressibility, ground effect and the wake
/// of the propeller.

#include <Eigen/Core>
#include <string>

#include "engine/api/flight_model.h"
#include "engine/api/parameter_table_fwd.h"

namespace vinerow::vehicles {

/// Defaults and their sources: the flying wing of assets/vehicles/mh900_like.yaml.
struct WingParams {
  double area_m2 = 0.27;
  double span_m = 0.90;
  double chord_m = 0.311;  ///< mean aerodynamic chord

  double lift_0 = 0.05, lift_alpha = 3.50, lift_rate = 4.2, lift_elevator = 0.806;
  double drag_0 = 0.025, oswald_efficiency = 0.85, drag_deflection = 0.15;
  double pitch_0 = 0.035, pitch_alpha = -0.309, pitch_rate = -1.145, pitch_elevator = -0.32;
  double side_beta = -0.327, side_p = -0.145, side_r = 0.244;
  double roll_beta = -0.188, roll_p = -0.384, roll_r = 0.152, roll_aileron = 0.194;
  double yaw_beta = 0.029, yaw_p = -0.047, yaw_r = -0.036, yaw_aileron = -0.0095;

  bool stall = true;             ///< false: linear at all angles
  double stall_angle_rad = 0.0;  ///< at which half of the flow has separated; constructor sets it
  double stall_blend = 50.0;     ///< M of eq. 4.10, 1/rad
  double plate_arm = 0.25;       ///< in chords, behind the centre of mass
  double stalled_control = 0.3;  ///< share of the elevons' effect that is left beyond stall

  WingParams();
  double aspect_ratio() const { return span_m * span_m / area_m2; }
  /// @throws ConfigError
  void validate(const std::string& who) const;
};

/// Elevon deflections, trailing edge down > 0.
struct Elevons {
  double left_rad = 0.0;
  double right_rad = 0.0;
  double elevator_rad() const { return 0.5 * (right_rad + left_rad); }
  double aileron_rad() const { return 0.5 * (left_rad - right_rad); }
};

/// Share of the wing that is stalled, eq. 4.10: 0 well inside, 1 well beyond +-stall_angle.
double stalled_share(const WingParams& params, double alpha_rad);

/// Lift and drag coefficients in steady straight flight, for trims, stall speed and tests.
struct LiftDrag {
  double lift = 0.0;
  double drag = 0.0;
  double pitch = 0.0;  ///< moment, nose up > 0
};
LiftDrag calc_lift_drag(const WingParams& params, double alpha_rad, const Elevons& elevons);

/// Force and torque about the centre of mass, in B. No heap.
AirLoad calc_wing_load(const WingParams& params, const AirPoint& air, const Elevons& elevons);

/// Largest lift coefficient of straight flight with the elevons where the pitching moment is zero,
/// within +-`elevon_max_rad`.
double calc_trimmed_lift_max(const WingParams& params, double elevon_max_rad);

/// Table of these values as scenario parameters: coefficients per rad, stall angle in deg.
const ParameterTable<WingParams>& wing_table();

}  // namespace vinerow::vehicles
