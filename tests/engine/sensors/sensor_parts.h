#pragma once
/// Sensors by their registered name, with parameters as a test says.

#include <string>
#include <utility>
#include <vector>

#include "engine/api/registry.h"
#include "engine/core/error.h"
#include "engine/sensors/register_sensors.h"

namespace vinerow::test {

inline const Registry& sensor_registry() {
  static const Registry registry = [] {
    Registry r;
    sensors::register_sensors(r);
    return r;
  }();
  return registry;
}

using SensorValues = std::vector<std::pair<std::string, ParameterSet::Value>>;

inline ParameterSet sensor_parameters(const std::string& type, const SensorValues& values = {}) {
  ParameterSet parameters(sensor_registry().spec(PartKind::kSensor, type).parameters, type);
  for (const auto& [name, value] : values) parameters.set(name, value);
  return parameters;
}

/// A window for a sensor's `outages`.
inline ParameterSet with_outage(ParameterSet parameters, double begin_s, double end_s) {
  ParameterSet window = parameters.make_group("outages");
  window.set("begin_s", begin_s).set("end_s", end_s);
  parameters.set("outages", std::vector<ParameterSet>{window});
  return parameters;
}

/// What a maker refuses.
template <class F>
std::string refusal_of(F&& f) {
  try {
    f();
  } catch (const ConfigError& error) {
    return error.what();
  } catch (const SimulationError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace vinerow::test
