#pragma once
/// Camera that photographs the ground: at intervals of time or distance, on the lanes of the plan
/// or always, never faster than its maximum rate. It does not render: a CameraShot contains the
/// pose of each picture and the visible part of the ground.
///
/// S has its x along the optical axis, y to the picture's left and z up in the picture. The default
/// mounting looks straight down, with the picture's upper edge ahead and its long side across the
/// track. With `mount: gimbal` that attitude is relative to a level frame with the vehicle's
/// heading instead of B; camera_gimbal.h defines the residual of roll and pitch. The camera's
/// position remains fixed to the vehicle.
///
/// The corners are the points where rays meet the true ground; plants and walls are ignored. A
/// picture with a corner beyond the ground, or above the horizon, is not `on_ground`. `distance_m`
/// and `gsd_m` are along the optical axis: gsd = distance sensor_width / (columns focal_length),
/// across the track. Both are zero if the axis does not meet the ground.
///
/// The camera triggers at ticks of the sensor: at once when a lane starts; then when `interval_s`
/// has passed since the last picture, or the position over ground is `distance_m` from that of the
/// last. A tick less than 1 / max_rate_Hz after the last picture never triggers, so the mean
/// interval is rounded up to a whole number of ticks.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec camera_trigger_spec();
/// @throws ConfigError if both interval_s and distance_m are given, or the interval is shorter than
/// the camera's minimum
std::unique_ptr<Sensor> make_camera_trigger(const ParameterSet& parameters,
                                            const SensorContext& context);

}  // namespace vinerow::sensors
