#pragma once
/// GNSS receiver model whose fix depends on the visible sky.
///
/// Each tick determines the satellites received through the true world (gnss_tracking.h, with the
/// constellations of gnss_sky.h), the mode that they allow (gnss_mode.h), and an error of that mode
/// and of the satellites' geometry (gnss_error.h). Between rows, fix and error are therefore worse
/// than above them. RTK uses the satellites received by carrier phase, the other modes those by
/// code.
///
///   outages  the antenna receives nothing: no fix, and satellites must be reacquired
///   jamming  C/N0 of all satellites falls by up to `drop_dB`, with a ramp of `ramp_s` at either
///            end of the window; if windows overlap, the strongest counts
///   delay_s  the receiver's latency
///
/// Without a position `valid` is false and every field but `satellites` is zero. Streams: errors,
/// fading and dropouts each have their own, and draw the same count at every tick. Not modelled:
/// wrongly resolved ambiguities, multipath, antenna phase centres, the positions of SBAS satellites
/// and the base station's link. The plain receiver of paper B is `gps`.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec gnss_spec();
/// @throws ConfigError for contradictory parameters, unknown constellations, an invalid epoch, or a
/// jamming window too short for its ramps
std::unique_ptr<Sensor> make_gnss(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
