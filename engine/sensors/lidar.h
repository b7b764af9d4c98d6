#pragma once
/// Scanning laser rangefinder in the plane z = 0 of S (2D): one ray, or a narrow fan, per beam.
///
/// A scan is instantaneous, so a moving vehicle's scan is not skewed. Beams run from right to left,
/// symmetrical about x of S.
///
/// Power and detection: laser_optics.h.
///
/// Divergence: a beam is `sub_rays` rays across its width. Returns within one pulse length of the
/// nearest of them add to the power. The reading is the nearest distance or, with `edge: mixed`,
/// the mean weighted by power: the points between a post and the wall behind it.
///
/// Reading: laser_optics.h; +infinity: nothing detected. The truth signal is the distance along the
/// beam's middle.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec lidar_spec();
/// @throws ConfigError if the angles make no beam or too many, or the range is empty
std::unique_ptr<Sensor> make_lidar(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
