#pragma once
/// Parameters of a flying wing. Defaults and their sources: assets/vehicles/mh900_like.yaml.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/part.h"
#include "engine/math/angles.h"
#include "vehicles/parts/battery.h"
#include "vehicles/parts/propeller.h"
#include "vehicles/parts/wing_aerodynamics.h"

namespace vinerow::vehicles {

enum class LaunchMode {
  kHand,      ///< thrown
  kCatapult,  ///< pushed along a rail
  kAir        ///< flies from the start
};

/// Launch.
struct LaunchParams {
  LaunchMode mode = LaunchMode::kHand;
  double height_m = 1.7;                      ///< of B above the ground, before the push
  double elevation_rad = rad_from_deg(15.0);  ///< of the push
  double incidence_rad = rad_from_deg(7.0);   ///< of body x above the push
  double length_m = 1.2;                      ///< of the push
  double speed_mps = 10.0;                    ///< at its end, over ground
  double throttle = 0.3;                      ///< command above which the push starts
  double start_height_m = 60.0;               ///< kAir: of B above the ground
  double start_speed_mps = 12.0;              ///< kAir: through the air, level
  std::optional<double> start_pitch_rad;      ///< kAir: nose up > 0; else that of level flight
};

/// Dimensions of the meshes and collision shapes. The root's leading edge is ahead of B.
struct AirframeShape {
  double root_chord_m = 0.40;
  double tip_chord_m = 0.20;
  double sweep_rad = rad_from_deg(30.0);  ///< of the leading edge
  double dihedral_rad = rad_from_deg(1.0);
  double leading_edge_m = 0.168;  ///< x of the root's leading edge in B
  double fin_height_m = 0.14;
  double fin_root_m = 0.17, fin_tip_m = 0.11;
  double fin_sweep_rad = rad_from_deg(25.0);
  double elevon_from = 0.35, elevon_to = 0.98;  ///< shares of the half span
  double elevon_chord = 0.25;                   ///< share of the chord
  double belly_m = 0.06;                        ///< lowest point below B
};

/// Fault during a flight, from the scenario.
struct FixedWingFault {
  enum class Kind { kMotorFailure, kElevonStuck, kBatteryEmpty };
  Kind kind = Kind::kMotorFailure;
  double at_s = 0.0;
  std::optional<bool> left = {};  ///< which elevon is stuck; absent: the left one
};

struct FixedWingParams {
  std::string name = "plane";
  double mass_kg = 1.2;
  Eigen::Vector3d inertia_kgm2 = {0.031, 0.019, 0.048};  ///< Jx, Jy, Jz
  double inertia_xz_kgm2 = 0.0005;  ///< J_xz = integral of x z dm, z down as in aviation
  WingParams wing;
  PropellerParams propeller;
  double elevon_limit_rad = rad_from_deg(25.0);
  double elevon_lag_s = 0.04;
  double elevon_rate_radps = 0.0;  ///< 0: no limit
  BatteryParams battery{22.2, 6.0};
  double cruise_speed_mps = 12.0;            ///< in the description, for controllers
  double max_speed_mps = 20.0;               ///< in the description, for controllers
  double max_bank_rad = rad_from_deg(45.0);  ///< in the description, for controllers
  LaunchParams launch;
  double landing_sink_limit_mps = 2.5;
  double landing_tilt_limit_rad = rad_from_deg(40.0);
  double belly_friction = 0.5;
  AirframeShape shape;
  std::vector<FixedWingFault> faults;

  /// @throws ConfigError
  void validate() const;
  /// Inertia in B (z up), so that J_xz changes its sign.
  Eigen::Matrix3d inertia_B() const;
  /// Lowest speed of level flight with balanced moments, without the propeller's pull, at 1.225
  /// kg/m3; infinite if there is no lift.
  double stall_speed_mps(double gravity_mps2) const;
};

/// Specification, as `vinerow list` shows it.
PartSpec fixed_wing_spec();

/// @param parameters  of fixed_wing_spec()
/// @throws ConfigError also if it cannot fly at its cruise speed
FixedWingParams read_fixed_wing_params(const ParameterSet& parameters, const std::string& name,
                                       double gravity_mps2);

}  // namespace vinerow::vehicles
