#pragma once
/// Inertial measurement unit: rate gyro and accelerometer (specific force), in the sensor frame S.
///
/// A reading is the mean over the period before it, as a real unit integrates inside at a far
/// higher rate: the rate gyro tells the rotation of the period over its length (coning is in it),
/// the accelerometer the change of S's velocity, gravity taken off, over its length, in the axes
/// that S has half way (sculling is in it). An estimator that turns by rate times period and adds
/// the turned force times period follows the true motion whatever happened between two readings. It
/// lags by half a period. The first reading tells the moment.
///
/// What is added: see triad.h and bias_instability.h; g-sensitivity of the gyro (a matrix, each
/// entry drawn once per run). Vibration of rotors and wheels is left out, as are the Earth's
/// turning (W is taken as inertial, as in the physics) and temperature. In an outage the unit is
/// silent.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec imu_spec();
std::unique_ptr<Sensor> make_imu(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
