#pragma once
/// Parameters that follow from a vehicle, for tests of what firmware is started with.

#include <cmath>
#include <string>
#include <vector>

#include "controllers/autopilot/mavlink/parameter_file.h"
#include "engine/api/stepped_parts.h"
#include "engine/math/angles.h"

namespace vinerow::controllers::autopilot_fake {

inline const GeoOrigin kOrigin{rad_from_deg(45.0), rad_from_deg(9.0), 150.0};

inline AutopilotContext context_of(const VehicleDescription& vehicle, Duration period) {
  AutopilotContext context;
  context.part = "rover.autopilot";
  context.period = period;
  context.vehicle_description = &vehicle;
  context.origin = kOrigin;
  return context;
}

/// NaN: there is no such parameter.
inline double value_of(const std::vector<FirmwareParameter>& parameters, const std::string& name) {
  for (const auto& parameter : parameters) {
    if (parameter.name == name) return parameter.value;
  }
  return std::nan("");
}

}  // namespace vinerow::controllers::autopilot_fake
