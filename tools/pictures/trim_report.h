#pragma once
/// Report of `vinerow trim` on a fixed-wing vehicle: steady flight, modes, sampled linear models
/// with their LQR gains, and limits of speed, climb and bank.

#include <optional>
#include <string>
#include <vector>

#include "controllers/parts/aircraft/aircraft_weights.h"
#include "controllers/parts/aircraft/flight_trim.h"

namespace vinerow::tools {

struct NamedMode {
  std::string name;  ///< "short period", "phugoid", "roll", "dutch roll", "spiral", or "mode"
  controllers::FlightMode mode;
};

struct TrimReport {
  controllers::Aircraft aircraft;
  controllers::Trim trim;
  double period_s = 0.05;
  std::vector<NamedMode> lon_modes, lat_modes;  ///< without the integrators of height and heading
  controllers::AircraftLaws laws;
  controllers::SpeedRange level;  ///< speeds of straight and level flight
  /// Climb angles at the trim's speed with wings level, at full and zero throttle. Absent if the
  /// elevons cannot hold them.
  std::optional<double> climb_max_rad, climb_min_rad;
  double bank_max_rad = 0.0;  ///< steepest level turn at the trim's speed
};

/// @throws ConfigError "<who>: no steady flight at ..."
TrimReport make_trim_report(const controllers::Aircraft& aircraft,
                            const controllers::TrimRequest& request, double period_s,
                            const std::string& who);

/// Report as text, angles in deg.
std::string to_text(const TrimReport& report);
/// Report as JSON in SI units and rad, keys with units; matrices are lists of rows.
std::string to_json(const TrimReport& report);

}  // namespace vinerow::tools
