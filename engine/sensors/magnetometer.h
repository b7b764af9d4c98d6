#pragma once
/// Magnetometer: flux density of the Earth's field in the sensor frame S.
///
/// Truth: the World Magnetic Model 2025 at the world's origin, the same everywhere in W, or the
/// given field. Magnetic north is not W's y axis: the horizontal field is turned to the east by the
/// declination. reading = limit(round(soft iron * truth + hard iron + white noise)): soft iron is I
/// plus a symmetric matrix, hard iron an offset, both as given plus a draw once per run. Fields of
/// motor currents, steel posts and wires are not modelled. In an outage the sensor sends nothing.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec magnetometer_spec();
std::unique_ptr<Sensor> make_magnetometer(const ParameterSet& parameters,
                                          const SensorContext& context);

}  // namespace vinerow::sensors
