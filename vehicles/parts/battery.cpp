#include "vehicles/parts/battery.h"

#include <algorithm>

#include "vehicles/parts/validation.h"

namespace vinerow::vehicles {

void BatteryParams::validate(const std::string& who) const {
  demand_positive(who, "battery_capacity_Wh", capacity_Wh);
  demand_not_negative(who, "electronics_W", electronics_W);
  demand_range(who, "initial_charge", initial_charge, 0.0, 1.0);
}

void advance_battery(const BatteryParams& params, double motors_W, double dt_s,
                     BatteryState& state) {
  state.power_W = params.electronics_W + motors_W;
  state.energy_used_J += state.power_W * dt_s;
  state.charge = std::clamp(
      params.initial_charge - state.energy_used_J / (params.capacity_Wh * 3600.0), 0.0, 1.0);
}

}  // namespace vinerow::vehicles
