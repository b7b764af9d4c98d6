#pragma once
/// GNSS heading from two antennas on one vehicle: heading and slope of their baseline by carrier
/// phase, also for a stationary vehicle.
///
/// The first antenna is at `position_m`, the second `baseline_m` ahead of it along x of S. Both
/// receive through the true world (gnss_tracking.h). The baseline is valid when six satellites have
/// been available by carrier phase, at the antenna that receives fewer, for as long as it takes to
/// resolve the ambiguities (gnss_mode.h). Otherwise `valid` is false and every field but
/// `satellites` is zero.
///
///   baseline = R_WS (L, 0, 0) + s (white_std n + walk_std g) on each axis
///
/// with n white, g a first-order Gauss-Markov process of unit variance and s the dilution of that
/// axis relative to the usual one, of the antenna with the larger dilution. The heading error is
/// std / L: twice the baseline, half the error. Not modelled: wrong ambiguities, and bending of the
/// structure between the antennas.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec gnss_heading_spec();
/// @throws ConfigError for contradictory parameters, unknown constellations, or an invalid epoch
std::unique_ptr<Sensor> make_gnss_heading(const ParameterSet& parameters,
                                          const SensorContext& context);

}  // namespace vinerow::sensors
