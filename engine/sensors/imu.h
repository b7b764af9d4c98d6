#pragma once
/// Inertial measurement unit: rate gyro and accelerometer (specific force), in the sensor frame S.
///
/// A reading is the mean over the period before it, because a real unit integrates internally at a
/// far higher rate. The rate gyro measures the rotation of the period divided by its length (coning
/// included). The accelerometer measures the change of S's velocity without gravity, divided by the
/// period, in the axes of S at the middle of the period (sculling included). An estimator that
/// turns by rate times period and adds the turned force times period follows the true motion,
/// whatever happened between two readings. A reading lags by half a period. The first reading is
/// the instantaneous value.
///
/// Errors: see triad.h and bias_instability.h; g-sensitivity of the gyro (a matrix, each entry
/// drawn once per run). Not modelled: vibration of rotors and wheels, the Earth's rotation (W is
/// inertial, as in the physics) and temperature. In an outage the unit sends nothing.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec imu_spec();
std::unique_ptr<Sensor> make_imu(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
