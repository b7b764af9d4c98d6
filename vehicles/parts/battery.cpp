#include "vehicles/parts/battery.h"

#include <algorithm>

#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {

void BatteryParams::validate(const std::string& who) const {
  battery_table().validate(*this, who);
}

const ParameterTable<BatteryParams>& battery_table() {
  using P = BatteryParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("battery_capacity_Wh", "Wh", &P::capacity_Wh, kPositive,
                  "energy of a full charge; once it is used, the motors stop")
          .number("electronics_W", "W", &P::electronics_W, between(0.0, 1e5),
                  "power drawn by computers, sensors and radio")
          .number("initial_charge", "", &P::initial_charge, between(0.0, 1.0),
                  "share of the capacity at the start");
  return table;
}

void advance_battery(const BatteryParams& params, double motors_W, double dt_s,
                     BatteryState& state) {
  state.power_W = params.electronics_W + motors_W;
  state.energy_used_J += state.power_W * dt_s;
  state.charge = std::clamp(
      params.initial_charge - state.energy_used_J / (params.capacity_Wh * 3600.0), 0.0, 1.0);
}

void report_empty_battery(Time now, const std::string& vehicle, SignalWriter<Event>& writer) {
  if (!writer.connected()) return;
  writer.write(now, {Event::Level::kError, vehicle, "battery empty: the wheels' motors stop"});
}

}  // namespace vinerow::vehicles
