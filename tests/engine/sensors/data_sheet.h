#pragma once
/// Sensors as the files of assets/sensors describe them.

#include <fmt/format.h>

#include "engine/scenario/scenario.h"
#include "tests/engine/sensors/sensor_parts.h"
#include "tests/support/paths.h"

namespace vinerow::test {

/// What a scenario reads from assets/sensors/<sheet>.yaml, through the scenario's own loader, with
/// what a test changes of it.
inline scenario::PartConfig data_sheet(const std::string& sheet, const SensorValues& values = {}) {
  Registry registry = sensor_registry();
  PartSpec world, cart;
  world.name = "flat";
  cart.name = "cart";
  registry.add_world(world, nullptr);
  registry.add_vehicle(cart, nullptr);
  const scenario::Scenario scenario = scenario::parse_scenario(
      fmt::format("vinerow: 1\nname: sheet\nduration_s: 1\nworld: {{type: flat}}\n"
                  "vehicles:\n  cart:\n    type: cart\n    spawn: {{x_m: 0, y_m: 0, yaw_deg: 0}}\n"
                  "    sensors: {{s: {{include: {}.yaml}}}}\n",
                  sheet),
      std::string(VINEROW_SOURCE_DIR) + "/assets/sensors", registry);
  scenario::PartConfig part = scenario.vehicles.at(0).sensors.at(0).part;
  for (const auto& [name, value] : values) part.parameters.set(name, value);
  return part;
}

}  // namespace vinerow::test
