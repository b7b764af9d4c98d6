#pragma once
/// Ultrasonic ranger: the first return inside a cone, from rays against terrain, canopy, posts and
/// obstacles.
///
/// The cone is a bundle: the axis and `rings` rings of rays out to the half angle. The reading is
/// the shortest hit, plus white noise, and +infinity beyond the range. Nearer than min_range_m the
/// reading is min_range_m.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow {

PartSpec ultrasound_spec();
std::unique_ptr<Sensor> make_ultrasound(const ParameterSet& parameters,
                                        const SensorContext& context);

}  // namespace vinerow
