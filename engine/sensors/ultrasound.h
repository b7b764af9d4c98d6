#pragma once
/// Ultrasonic ranger: the first return that is heard inside a cone, from rays against terrain,
/// canopy, posts and obstacles.
///
/// The cone is a bundle of rays (sound_cone.h). By default every return is heard and the reading is
/// the shortest hit plus noise; with an `echo_threshold` an echo must be strong enough (echo.h), so
/// smooth surfaces seen aslant and slim things far away are lost. Then, in this order: the error
/// of the speed of sound, noise, resolution; a missed echo; a false echo before the true one.
/// +infinity: nothing heard within the range. Nearer than min_range_m the reading is min_range_m.
/// Beside it stands the truth: distance of the bundle's first return, with none of these errors.
///
/// Several rangers that fire in turn: the same `cycle_s` and a `phase_s` each. Nobody hears
/// another's pulse; what crosstalk does is told by `false_share`. The pulse takes no time.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec ultrasound_spec();
/// @throws ConfigError if cycle, phase and rate do not go together, or the range is empty
std::unique_ptr<Sensor> make_ultrasound(const ParameterSet& parameters,
                                        const SensorContext& context);

}  // namespace vinerow::sensors
