#pragma once
/// Simple satellite receiver: fixes of the antenna in W and WGS84.
///
/// Errors (all zero in the `ideal` model):
///   uniform   independent in [-accuracy_m, accuracy_m] on east and north, every fix: the location
///             error of paper B, section 3 (the height has no error)
///   gaussian  white, horizontal_std_m and vertical_std_m, plus a first-order Gauss-Markov part
///             (walk_std_m, walk_time_s): the slow drift of a real receiver
/// Stream: one per sensor; every fix draws the same number of values, so an outage does not shift
/// later errors.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec gps_spec();
std::unique_ptr<Sensor> make_gps(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
