#include "controllers/parts/aircraft/aircraft.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"

namespace vinerow::controllers {

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
  Aircraft aircraft{description.need_fixed_wing(who), description.type, gravity_mps2};
  if (!aircraft.flight_model) {
    throw ConfigError(fmt::format("{} needs 'flight_model', which vehicle type '{}' does not have",
                                  who, description.type));
  }
  const auto demand = [&](double value, const char* name) {
    description.need_positive(value, name, who);
  };
  demand(aircraft.span_m, "span_m");
  demand(aircraft.air_density_kgm3, "air_density_kgm3");
  demand(aircraft.cruise_speed_mps, "cruise_speed_mps");
  demand(aircraft.stall_speed_mps, "stall_speed_mps");
  demand(aircraft.max_bank_rad, "max_bank_rad");
  aircraft.throttle = description.actuator_index("throttle", who);
  aircraft.elevon_left = description.actuator_index("elevon_left_rad", who);
  aircraft.elevon_right = description.actuator_index("elevon_right_rad", who);
  aircraft.actuators = description.actuators;
  return aircraft;
}

}  // namespace vinerow::controllers
