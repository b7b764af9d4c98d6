#pragma once
/// What `vinerow trim` tells of a vehicle on wings: steady flight, modes, sampled linear models
/// with their LQR gains, and how slow, fast, steep and banked it can fly.

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
  controllers::SpeedRange level;  ///< straight and level
  /// At the trim's speed with wings level: full throttle and none. Absent where the elevons do not
  /// hold it.
  std::optional<double> climb_max_rad, climb_min_rad;
  double bank_max_rad = 0.0;  ///< steepest level turn at the trim's speed
};

/// @throws ConfigError "<who>: no steady flight at ..."
TrimReport make_trim_report(const controllers::Aircraft& aircraft,
                            const controllers::TrimRequest& request, double period_s,
                            const std::string& who);

/// Several lines, angles in deg.
std::string to_text(const TrimReport& report);
/// SI and rad, keys with units; matrices as lists of rows.
std::string to_json(const TrimReport& report);

}  // namespace vinerow::tools
