#pragma once
/// Battery model: a store of energy.

#include <string>

#include "engine/api/messages/event.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/api/signal.h"

namespace vinerow::vehicles {

struct BatteryParams {
  double capacity_Wh = 1000.0;  ///< > 0
  double electronics_W = 30.0;  ///< constant load of computers, sensors and radio, >= 0
  double initial_charge = 1.0;  ///< share of the capacity at the start, 0..1

  /// @throws ConfigError
  void validate(const std::string& who) const;
};

/// battery_capacity_Wh, electronics_W, initial_charge
const ParameterTable<BatteryParams>& battery_table();

/// Draws power for dt_s. Recovered energy raises the charge, up to full.
/// @param motors_W  sum of the motors, negative if braking recovers energy
void advance_battery(const BatteryParams& params, double motors_W, double dt_s,
                     BatteryState& state);

/// Writes the event of a ground vehicle whose battery is empty, if the writer is connected.
void report_empty_battery(Time now, const std::string& vehicle, SignalWriter<Event>& writer);

}  // namespace vinerow::vehicles
