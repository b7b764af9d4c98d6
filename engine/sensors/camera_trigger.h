#pragma once
/// A camera that takes pictures of the ground by itself: every so often or every so far, on the
/// lanes of the plan or always, never faster than it can. It draws nothing: it tells where each
/// picture was taken and what of the ground it shows (CameraShot).
///
/// S looks along x, y is the picture's left and z up in it: as mounted by default straight down,
/// with the picture's upper edge ahead and its long side across the track. With `mount: gimbal`
/// that attitude is to a level frame of the vehicle's heading instead of to B: camera_gimbal.h
/// tells what of roll and pitch remains. The camera's place stays that on the vehicle.
///
/// The corners are where rays meet the true ground, plants and walls not seen; a picture with a
/// corner beyond the ground, or above the horizon, is not `on_ground`. `distance_m` and `gsd_m` are
/// along the optical axis: gsd = distance sensor_width / (columns focal_length), across the track;
/// both are zero where the axis meets no ground.
///
/// Triggering, at the sensor's ticks: at once when a lane begins; then when `interval_s` has gone
/// by since the last picture, or the place over ground is `distance_m` from that of the last. A
/// tick at which less than 1 / max_rate_Hz has gone by never triggers, so that the mean interval is
/// the next whole number of ticks.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec camera_trigger_spec();
/// @throws ConfigError if both interval_s and distance_m are given, or the interval is shorter than
/// the camera's fastest
std::unique_ptr<Sensor> make_camera_trigger(const ParameterSet& parameters,
                                            const SensorContext& context);

}  // namespace vinerow::sensors
