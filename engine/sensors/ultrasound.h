#pragma once
/// Ultrasonic ranger: the first detected return inside a cone, from rays against terrain, canopy,
/// posts and obstacles.
///
/// The cone is a bundle of rays (sound_cone.h). By default every return is detected and the reading
/// is the shortest hit plus noise. With an `echo_threshold` an echo must be strong enough (echo.h),
/// so smooth surfaces at an angle and slim distant objects are lost. Then follow, in this order:
/// the error of the speed of sound, noise, resolution; a missed echo; a false echo before the true
/// one. +infinity: no echo within the range. Below min_range_m the reading is min_range_m. The
/// truth signal is the distance of the bundle's first return, without these errors.
///
/// Several rangers can fire in turn: the same `cycle_s` and a different `phase_s` for each. A
/// ranger never receives another's pulse; `false_share` models crosstalk. The pulse takes no time.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec ultrasound_spec();
/// @throws ConfigError if cycle, phase and rate are inconsistent, or the range is empty
std::unique_ptr<Sensor> make_ultrasound(const ParameterSet& parameters,
                                        const SensorContext& context);

}  // namespace vinerow::sensors
