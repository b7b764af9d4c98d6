#pragma once
/// Helpers shared by the sources of VehicleRuntime that build the parts of a vehicle.

#include <fmt/format.h>

#include <string>

#include "engine/core/error.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow {

/// Runs `make` and prefixes the ConfigErrors of a vehicle's part with the part's place in the
/// scenario file.
template <class Make>
auto with_place(const io::SourceMark& where, const std::string& vehicle, Make&& make) {
  try {
    return make();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    // Other messages already start with a place: that of a file or of the key.
    if (!text.starts_with(vehicle + ".") && !text.starts_with(vehicle + ":")) throw;
    throw ConfigError(fmt::format("{}: {}", where.text(), text));
  }
}

template <class Context>
Context VehicleRuntime::context(const std::string& part, double rate_Hz) const {
  Context result;
  result.vehicle = config_.name;
  result.part = part;
  result.seed = run_.scenario.seed;
  result.period = rate_Hz > 0.0 ? period_of_rate(rate_Hz) : Duration{};
  result.physics_step = run_.scenario.physics_step;
  result.gravity_mps2 = run_.scenario.gravity_mps2;
  result.shelf = run_.shelf;
  return result;
}

}  // namespace vinerow
