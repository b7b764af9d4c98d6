#pragma once
/// All messages that we know.

#include "engine/mavlink/command_messages.h"
#include "engine/mavlink/hil_messages.h"
#include "engine/mavlink/mission_messages.h"
#include "engine/mavlink/status_messages.h"

namespace vinerow::mavlink {

template <class... Messages>
struct MessageList {};

using AllMessages =
    MessageList<Heartbeat, SysStatus, SystemTime, SetMode, ParamRequestRead, ParamRequestList,
                ParamValue, ParamSet, GpsRawInt, Attitude, LocalPositionNed, GlobalPositionInt,
                GpsGlobalOrigin, NavControllerOutput, MissionRequest, MissionSetCurrent,
                MissionCurrent, MissionRequestList, MissionCount, MissionClearAll,
                MissionItemReached, MissionAck, MissionRequestInt, RcChannels, RequestDataStream,
                MissionItemInt, VfrHud, CommandInt, CommandLong, CommandAck,
                SetPositionTargetLocalNed, HilActuatorControls, HilSensor, HilGps,
                HilStateQuaternion, DistanceSensor, BatteryStatus, AutopilotVersion,
                EkfStatusReport, GpsInput, HomePosition, StatusText>;

}  // namespace vinerow::mavlink
