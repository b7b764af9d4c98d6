#pragma once
/// Readings of our receiver as an autopilot takes them for its own (MAVLink's GPS_INPUT).

#include "engine/api/messages/sensors.h"
#include "engine/core/time.h"
#include "engine/mavlink/messages.h"

namespace vinerow::controllers {

/// Unix time of a run's start, for firmware that wants a date: 2024-06-21, 10:00 UTC. Fixed, so
/// that runs repeat.
inline constexpr std::int64_t kFirmwareStart_s = 1'718'964'000;

mavlink::GpsInput make_gps_input(const GnssFix& fix, Time now);

}  // namespace vinerow::controllers
