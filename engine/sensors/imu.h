#pragma once
/// Inertial measurement unit: rate gyro and accelerometer (specific force), in the sensor frame S.
///
/// reading = true + bias + white noise, then limited to the range. The white noise per sample is
/// density / sqrt(period); the bias is constant per run plus a random walk of the given density.
/// At rest on level ground the accelerometer reads +g along z.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow {

PartSpec imu_spec();
std::unique_ptr<Sensor> make_imu(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow
