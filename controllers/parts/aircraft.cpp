#include "controllers/parts/aircraft.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"

namespace vinerow {

void Aircraft::mix(const AircraftControls& controls, std::vector<double>& actuator_values) const {
  actuator_values[static_cast<std::size_t>(throttle)] = controls.throttle;
  actuator_values[static_cast<std::size_t>(elevon_left)] =
      controls.elevator_rad + controls.aileron_rad;
  actuator_values[static_cast<std::size_t>(elevon_right)] =
      controls.elevator_rad - controls.aileron_rad;
}

AircraftControls Aircraft::limit(const AircraftControls& controls) const {
  const auto limited = [&](int index, double value) {
    const ActuatorSpec& spec = actuators[static_cast<std::size_t>(index)];
    return std::clamp(value, spec.min, spec.max);
  };
  const double left = limited(elevon_left, controls.elevator_rad + controls.aileron_rad);
  const double right = limited(elevon_right, controls.elevator_rad - controls.aileron_rad);
  return {limited(throttle, controls.throttle), 0.5 * (left + right), 0.5 * (left - right)};
}

Aircraft read_aircraft(const VehicleDescription& description, double gravity_mps2,
                       const std::string& who) {
  if (!description.flight_model) {
    throw ConfigError(fmt::format("{}: vehicle type '{}' has no wings", who, description.type));
  }
  Aircraft aircraft;
  aircraft.type = description.type;
  aircraft.model = description.flight_model;
  aircraft.gravity_mps2 = gravity_mps2;
  aircraft.span_m = description.number("wing_span_m", who);
  aircraft.cruise_speed_mps = description.number("cruise_speed_mps", who);
  aircraft.stall_speed_mps = description.number("stall_speed_mps", who);
  aircraft.max_bank_rad = description.number("max_bank_rad", who);
  aircraft.throttle_lag_s = description.number("throttle_lag_s", who);
  aircraft.elevon_lag_s = description.number("elevon_lag_s", who);
  const auto told = [&](const char* name, double otherwise) {
    const auto found = description.numbers.find(name);
    return found == description.numbers.end() ? otherwise : found->second;
  };
  aircraft.air_density_kgm3 = told("air_density_kgm3", aircraft.air_density_kgm3);
  aircraft.wing_area_m2 = told("wing_area_m2", 0.0);
  aircraft.throttle = description.actuator_index("throttle", who);
  aircraft.elevon_left = description.actuator_index("elevon_left_rad", who);
  aircraft.elevon_right = description.actuator_index("elevon_right_rad", who);
  aircraft.actuators = description.actuators;
  return aircraft;
}

}  // namespace vinerow
