#include "controllers/estimation/row_localisation/range_sensors.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow::controllers {

std::vector<RangeSensorModel> find_range_sensors(const std::vector<std::string>& names,
                                                 const EstimatorContext& context,
                                                 const std::string& who, const std::string& key) {
  std::vector<RangeSensorModel> found;
  const auto add = [&](const SensorMounting& mounting) {
    RangeSensorModel sensor;
    sensor.name = mounting.name;
    sensor.X_BS = mounting.X_BS;
    found.push_back(sensor);
  };
  if (names.empty()) {
    for (const SensorMounting& mounting : context.sensors) {
      if (mounting.type == "ultrasound") add(mounting);
    }
    return found;
  }
  for (const std::string& name : names) {
    if (std::count(names.begin(), names.end(), name) > 1) {
      throw ConfigError(fmt::format("{}: {} names '{}' twice", who, key, name));
    }
    const auto mounting =
        std::find_if(context.sensors.begin(), context.sensors.end(),
                     [&](const SensorMounting& sensor) { return sensor.name == name; });
    if (mounting == context.sensors.end()) {
      std::vector<std::string> known;
      for (const SensorMounting& sensor : context.sensors) known.push_back(sensor.name);
      throw ConfigError(fmt::format("{}: {} names '{}', but the vehicle's mounted sensors are: {}",
                                    who, key, name, known.empty() ? "none" : join(known)));
    }
    add(*mounting);
  }
  return found;
}

void demand_row_meshes(const EstimatorContext& context, const std::string& who,
                       const std::string& advice) {
  if (context.map != nullptr && !context.map->meshes.empty()) return;
  throw ConfigError(
      fmt::format("{}: the map has no row meshes to compare ranges with; give the vehicle a map "
                  "with row meshes{}",
                  who, advice.empty() ? "" : ", or " + advice));
}

}  // namespace vinerow::controllers
