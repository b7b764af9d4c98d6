#pragma once
/// A satellite positioning receiver as it is: what it tells depends on the sky it sees.
///
/// At every tick: which satellites it hears through the true world (gnss_tracking.h, with the
/// constellations of gnss_sky.h), which mode that allows (gnss_mode.h), and an error of that mode
/// and of the satellites' geometry (gnss_error.h). So between rows fix and error are worse than
/// above them. RTK uses the satellites heard by carrier phase, the other modes those by code.
///
///   outages  the antenna hears nothing: no fix, and satellites have to be found again
///   jamming  C/N0 of all satellites falls by up to `drop_dB`, with a ramp of `ramp_s` at either
///            end of the window; where windows overlap the strongest counts
///   delay_s  the receiver's latency
///
/// Without a position `valid` is false and everything but `satellites` zero. Streams: errors,
/// fading and dropouts each have their own, and draw the same count at every tick.
/// Left out: wrongly resolved ambiguities, reflected signals, antenna phase centres, the place of
/// SBAS satellites and the base station's link. The plain receiver of paper B is `gps`.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec gnss_spec();
/// @throws ConfigError for contradictory parameters, unknown constellations, an epoch that is no
/// date, a jamming window too short for its ramps
std::unique_ptr<Sensor> make_gnss(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
