#pragma once
/// Types of signals: plain structs in SI units. Each lists its fields once, with name and unit
/// (field.h); digest, logs, viewers and scripts derive from that list. engine/record maps each to a
/// ROS 2 message.
///
/// Frames: W world (East-North-Up at the scenario's origin), B body (x forward, y left, z up), S
/// sensor.
///
/// Plug-ins include this header, which has all messages. The project's own sources include only the
/// topics that they use.

#include "engine/api/messages/camera.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/flight.h"
#include "engine/api/messages/grid.h"
#include "engine/api/messages/heading.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/path.h"
#include "engine/api/messages/sensors.h"

namespace vinerow {

/// Calls `f` once per built-in message type, with a null pointer of that type.
template <class F>
void for_each_message_type(F&& f) {
  f(static_cast<Odometry*>(nullptr));
  f(static_cast<DeadReckoning*>(nullptr));
  f(static_cast<ImuSample*>(nullptr));
  f(static_cast<GnssFix*>(nullptr));
  f(static_cast<GnssHeading*>(nullptr));
  f(static_cast<RangeSample*>(nullptr));
  f(static_cast<PressureSample*>(nullptr));
  f(static_cast<MagneticSample*>(nullptr));
  f(static_cast<LaserScan*>(nullptr));
  f(static_cast<PointCloud*>(nullptr));
  f(static_cast<Picture*>(nullptr));
  f(static_cast<CameraInfo*>(nullptr));
  f(static_cast<PositionEllipsoid*>(nullptr));
  f(static_cast<PoseTarget*>(nullptr));
  f(static_cast<VelocityCommand*>(nullptr));
  f(static_cast<LocalCommand*>(nullptr));
  f(static_cast<LineList*>(nullptr));
  f(static_cast<OccupancyGrid*>(nullptr));
  f(static_cast<NamedValues*>(nullptr));
  f(static_cast<LinkPoses*>(nullptr));
  f(static_cast<PlannedPath*>(nullptr));
  f(static_cast<FollowerState*>(nullptr));
  f(static_cast<MovementAuthority*>(nullptr));
  f(static_cast<ReferenceTrajectory*>(nullptr));
  f(static_cast<AirReference*>(nullptr));
  f(static_cast<AirData*>(nullptr));
  f(static_cast<CameraShot*>(nullptr));
  f(static_cast<BatteryState*>(nullptr));
  f(static_cast<Event*>(nullptr));
}

}  // namespace vinerow
