#pragma once
/// Two satellite antennas on one vehicle, the second relative to the first by carrier phase: the
/// heading and the slope along their baseline, also of a vehicle that stands.
///
/// The first antenna sits at `position_m`, the second `baseline_m` ahead of it along x of S. Both
/// look at the sky past the true world (gnss_tracking.h). The baseline is told once six satellites
/// serve by carrier phase at the antenna that hears fewer, for as long as it takes to resolve the
/// ambiguities (gnss_mode.h); without them `valid` is false and everything but `satellites` zero.
///
///   baseline = R_WS (L, 0, 0) + s (white_std n + walk_std g) on each axis
///
/// with n white, g a first-order Gauss-Markov process of unit variance and s the dilution of that
/// axis over the usual one, of the antenna that is worse off. So the heading errs by std / L: twice
/// the baseline, half the error. Left out: wrong ambiguities, bending of what carries the antennas.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec gnss_heading_spec();
/// @throws ConfigError for contradictory parameters, unknown constellations, an epoch that is no
/// date
std::unique_ptr<Sensor> make_gnss_heading(const ParameterSet& parameters,
                                          const SensorContext& context);

}  // namespace vinerow::sensors
