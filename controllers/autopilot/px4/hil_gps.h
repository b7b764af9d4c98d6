#pragma once
/// Readings of our receiver as PX4's simulated one (MAVLink's HIL_GPS).

#include "engine/api/messages/sensors.h"
#include "engine/core/time.h"
#include "engine/mavlink/messages.h"

namespace vinerow::controllers {

/// PX4 takes eph and epv for accuracies in cm, as its own simulators send them, not for the
/// dilutions of MAVLink's definition.
mavlink::HilGps make_hil_gps(const GnssFix& fix, Time now);

}  // namespace vinerow::controllers
