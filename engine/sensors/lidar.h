#pragma once
/// Scanning laser rangefinder in the plane z = 0 of S (2D): one ray, or a narrow fan, per beam.
///
/// A scan is instantaneous, so a moving vehicle's scan is not skewed. Beams run from right to left,
/// symmetrical about x of S.
///
/// Received power of a beam, 1 for a surface of 10 % reflectance at normal incidence at
/// dark_range_m: P = reflectance / 0.1 x cos(incidence) x (dark_range / r)^2. It is detected with
/// probability P^4 / (P^4 + 1/9): 0.9 at P = 1, one half at P = 0.58. Data sheets state the range
/// on white and on 10 % targets; the slope between them (power 4) is chosen.
///
/// Divergence: a beam is `sub_rays` rays across its width. Returns within one pulse length of the
/// nearest of them add to the power. The reading is the nearest distance or, with `edge: mixed`,
/// the mean weighted by power: the points between a post and the wall behind it.
///
/// Reading: + a constant error of the device, drawn once from +-accuracy_m, + white noise of
/// noise_std_m + noise_growth r. +infinity: nothing detected. The truth signal is the distance
/// along the beam's middle.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec lidar_spec();
/// @throws ConfigError if the angles make no beam or too many, or the range is empty
std::unique_ptr<Sensor> make_lidar(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
