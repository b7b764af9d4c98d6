#pragma once
/// Barometer: static pressure of the air at the sensor.
///
/// Truth: US Standard Atmosphere 1976 at the altitude of S (the world's origin plus z; the
/// ellipsoid counts as mean sea level), times the ratio of the day's sea level pressure to the
/// standard's. A reading adds white noise, a drift (Gauss-Markov), a bias drawn once per run, and a
/// share of the dynamic pressure rho v^2 / 2 of the vehicle's velocity through the air; then it is
/// rounded. Turbulence and the rotors' own pressure are not modelled. In an outage the sensor sends
/// nothing.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec barometer_spec();
std::unique_ptr<Sensor> make_barometer(const ParameterSet& parameters,
                                       const SensorContext& context);

}  // namespace vinerow::sensors
