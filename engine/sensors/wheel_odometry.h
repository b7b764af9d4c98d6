#pragma once
/// Odometry of a vehicle's own computer: where its wheels have brought it since the start.
///
/// At each tick it reads the steering angles and wheel speeds (with the errors of `encoders`),
/// solves them for the motion in the plane (wheel_motion.h) and adds the motion since the last
/// tick, of the mean twist along an arc. It goes on in outages and dropouts. Systematic
/// errors, drawn once per run, are those that Borenstein and Feng ("Measurement and correction of
/// systematic odometry errors in mobile robots", IEEE Trans. Robotics and Automation 12, 1996)
/// found to matter: unequal wheel radii and a wrong track. Slip and slopes add what they do to the
/// true wheels.
///
/// Writes DeadReckoning: planar, z = 0, without roll and pitch. The truth beside it is the whole
/// true pose relative to the frame at the start, which is level.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec wheel_odometry_spec();
/// @throws ConfigError as WheelMotion, and if the vehicle does not model its actuator states
std::unique_ptr<Sensor> make_wheel_odometry(const ParameterSet& parameters,
                                            const SensorContext& context);

}  // namespace vinerow::sensors
