#pragma once
/// Tyre model: horizontal force of a rolling, sliding or resting tyre, with a bristle state.
///
/// Carcass and tread are one elastic bristle per axis. Its deflection xi (in multiples of the
/// relaxation length L, positive against the sliding direction) follows
///
///   L dxi_i/dt = -v_si - Lambda_i xi_i,          F_i = N c_i (xi_i + tau dxi_i/dt),
///   Lambda_i   = |V_r| rho_i / (1 - exp(-rho_i)), rho_i = c_i s / (mu_i^2 |V_r|),
///   s          = sqrt((mu_x v_sx)^2 + (mu_y v_sy)^2)
///
/// with the sliding velocity v_s = (v_x - R omega, v_y) and the speed V_r = R omega at which new
/// tread enters the patch. In steady pure slip this is the traction curve of Wismer and Luth,
/// F/N = mu (1 - exp(-c sigma / mu)), sigma = |v_s / V_r|; in full sliding the force opposes the
/// sliding and reaches the friction ellipse; at standstill (V_r = 0, v_s -> 0) it is a damped
/// spring, so a parked vehicle does not creep.
///
/// Sources: dynamics and combined slip: Velenis, Tsiotras, Canudas-de-Wit, Sorine, "Dynamic tyre
/// friction models for combined longitudinal and lateral vehicle motion", Vehicle System Dynamics
/// 43(1), 2005, eq. 9-14. Saturation: Wismer, Luth, "Off-road traction prediction for wheeled
/// vehicles", Trans. ASAE 17(1), 1974. Two differences: the saturation is exponential instead of
/// hyperbolic, and the spring acts on xi = deflection / L so that L is the relaxation length at
/// small slip.
/// Frames: contact frame C (x rolling direction, y left, z ground normal).
/// Cost: no heap; about 60 ns per step.

#include <Eigen/Core>
#include <string>

#include "engine/api/parameter_table_fwd.h"
#include "engine/api/soil.h"

namespace vinerow::vehicles {

struct TyreParams {
  double relaxation_length_m = 0.12;    ///< > 0
  double damping_time_s = 0.02;         ///< tau, >= 0; matters at standstill only
  double lateral_friction_ratio = 1.0;  ///< mu_y / mu_x, > 0
  double stribeck_speed_mps = 1.0;      ///< > 0; sliding speed at which friction falls to sliding

  /// @throws ConfigError naming `who`, the field, its value and its range
  void validate(const std::string& who) const;
};

/// relaxation_length_m, tyre_damping_time_s, lateral_friction_ratio, stribeck_speed_mps
const ParameterTable<TyreParams>& tyre_table();

struct TyreState {
  Eigen::Vector2d xi = Eigen::Vector2d::Zero();  ///< deflection / L along x and y of C
};

/// Tyre during a step, with the force as a function of the new spin: F_x = fx0 + fx1 * omega.
struct TyreStep {
  double load_N = 0.0;
  Eigen::Vector2d peak = {0, 0};       ///< mu_x, mu_y at zero sliding speed
  Eigen::Vector2d stiffness = {0, 0};  ///< c_x, c_y
  Eigen::Vector2d gain = {0, 0};       ///< 1 / (1 + dt Lambda / L)
  Eigen::Vector2d velocity = {0, 0};   ///< of the vehicle at the patch, in C, m/s
  double fx0_N = 0.0;
  double fx1_Ns = 0.0;  ///< >= 0
};

class Tyre {
 public:
  Tyre(const TyreParams& params, double radius_m) : params_(params), radius_m_(radius_m) {}

  /// @param velocity_C  of the vehicle's rigid body at the contact point, x and y of C, m/s
  /// @param load_N      >= 0
  TyreStep begin(const TyreState& state, const Eigen::Vector2d& velocity_C, double spin_radps,
                 double load_N, const Soil& soil, double dt_s) const;

  /// @param spin_radps  at the end of the step
  /// Advances `state`.
  /// @returns force of the ground on the tyre along x and y of C, N, within the friction ellipse
  Eigen::Vector2d finish(const TyreStep& step, double spin_radps, double dt_s,
                         TyreState& state) const;

  /// Stribeck law: friction at a sliding speed.
  static double calc_friction(const Soil& soil, double sliding_speed_mps, double stribeck_mps);

  const TyreParams& params() const { return params_; }
  double radius_m() const { return radius_m_; }

 private:
  TyreParams params_;
  double radius_m_;
};

}  // namespace vinerow::vehicles
