#pragma once
/// Soil model of wheels.

#include <string>

namespace vinerow {

/// Friction and stiffness of wheels on a soil. Sources of the built-in soils:
/// vehicles/parts/README.md.
struct Soil {
  std::string name = "dry_grass";
  double peak_friction = 0.75;                ///< largest force / load
  double sliding_friction = 0.65;             ///< force / load at full slip
  double slip_stiffness = 15.0;               ///< d(force/load)/d(slip) at zero slip
  double cornering_stiffness_per_rad = 10.0;  ///< d(force/load)/d(slip angle) at zero
  double rolling_resistance = 0.06;           ///< force / load
};

}  // namespace vinerow
