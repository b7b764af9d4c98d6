#pragma once
/// Air data sensor (pitot tube and vanes): the vehicle's velocity through the air, in B.
///
/// reading = (1 + scale error) * lagged truth + white noise per axis. The lag is of first order and
/// exact for an air velocity that is constant over a period. Below the minimum airspeed that its
/// pressure sensor resolves the reading is zero, as in an outage.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec air_data_spec();
std::unique_ptr<Sensor> make_air_data(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
