#pragma once
/// Parameters of a quadrotor. Defaults: paper A's Q4T; sources: assets/vehicles/quadrotor_q4t.yaml.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/part.h"
#include "engine/math/angles.h"
#include "vehicles/parts/battery.h"
#include "vehicles/parts/ground_effect.h"
#include "vehicles/parts/landing_foot.h"
#include "vehicles/parts/rotor.h"

namespace vinerow::vehicles {

constexpr std::size_t kRotors = 4;

enum class QuadrotorLayout {
  kX,    ///< two rotors ahead: front left, rear left, rear right, front right
  kPlus  ///< one rotor ahead: front, left, rear, right
};

/// Fault during a flight, from the scenario.
struct QuadrotorFault {
  enum class Kind { kRotorFailure, kBatteryEmpty };
  Kind kind = Kind::kRotorFailure;
  double at_s = 0.0;
  std::optional<std::size_t> rotor;      ///< 0..3; of a rotor failure
  std::optional<double> remaining = {};  ///< share of its thrust that is left, 0..1; absent: 0
};

struct QuadrotorParams {
  std::string name = "drone";
  QuadrotorLayout layout = QuadrotorLayout::kX;
  double mass_kg = 2.0;  ///< of the whole vehicle
  Eigen::Vector3d inertia_kgm2 = {0.050, 0.050,
                                  0.0977};  ///< about B's axes, with the rotors at rest
  double arm_m = 0.31;                      ///< from B's z axis to a hub
  double rotor_radius_m = 0.19;
  double rotor_height_m = 0.05;  ///< of the rotors' plane above B
  double stand_height_m = 0.22;  ///< of B above level ground
  double gear_radius_m = 0.20;   ///< from B's z axis to a foot
  LandingFootParams foot;        ///< each; its static load follows from the weight
  RotorParams rotor;
  double rotor_drag_Ns_per_m = 0.30;  ///< of all rotors at hover, across their axes
  double inflow_drag_Ns_per_m = 0.0;  ///< of all rotors at hover, along their axes
  double body_drag_area_m2 = 0.04;    ///< C_d A
  GroundEffectModel ground_effect = GroundEffectModel::kMultirotor;
  double ground_effect_body_lift = 2.0;
  double motor_efficiency = 0.75;
  BatteryParams battery{111.0, 15.0};
  double landing_speed_limit_mps = 1.0;
  double landing_tilt_limit_rad = rad_from_deg(30.0);
  double max_tilt_rad = rad_from_deg(25.0);  ///< in the description, for controllers
  double max_speed_mps = 10.0;               ///< in the description, for controllers
  double min_turning_radius_m = 1.77;        ///< in the description, for planners
  std::vector<QuadrotorFault> faults;

  /// @throws ConfigError, e.g. "drone: makes 18.0 N at most, but weighs 19.6 N: it cannot hover"
  void validate(double gravity_mps2) const;

  /// Hub of a rotor in B. Rotors count counter-clockwise as seen from above.
  Eigen::Vector3d hub_B(std::size_t i) const;
  /// +1: its drag torque turns the body to the left. Paper C, section 2.1: rotors 1 and 3 turn
  /// counter-clockwise, so theirs turn the body to the right.
  static double torque_sign(std::size_t i) { return i % 2 == 0 ? -1.0 : 1.0; }
  /// Lowest point of the foot under the arm of a rotor.
  Eigen::Vector3d foot_B(std::size_t i) const;

  double max_thrust_N() const;
  /// Speed at which the rotors carry the weight at standard gravity in free air.
  double hover_radps() const;
  /// Drag coefficients per rotor speed that give the parameters' sums at hover.
  RotorAir rotor_air() const;
};

/// Specification, as `vinerow list` shows it.
PartSpec quadrotor_spec();

/// @param parameters  of quadrotor_spec()
/// @throws ConfigError
QuadrotorParams read_quadrotor_params(const ParameterSet& parameters, const std::string& name,
                                      double gravity_mps2);

}  // namespace vinerow::vehicles
