#pragma once
/// Numbers of MAVLink's enumerations, as far as they are used.
/// Source: message sets "minimal" and "common" of MAVLink.

#include <cstdint>

namespace vinerow::mavlink {

// MAV_TYPE
inline constexpr std::uint8_t kTypeFixedWing = 1, kTypeQuadrotor = 2, kTypeGroundRover = 10;
// MAV_AUTOPILOT; invalid: a ground station, a camera
inline constexpr std::uint8_t kAutopilotGeneric = 0, kAutopilotArdupilot = 3, kAutopilotInvalid = 8,
                              kAutopilotPx4 = 12;
// MAV_MODE_FLAG
inline constexpr std::uint8_t kModeFlagCustom = 1, kModeFlagArmed = 128;
// MAV_STATE
inline constexpr std::uint8_t kStateStandby = 3, kStateActive = 4, kStateEmergency = 6;
// MAV_SEVERITY
inline constexpr std::uint8_t kSeverityError = 3, kSeverityWarning = 4, kSeverityInfo = 6;
// MAV_SYS_STATUS_SENSOR
inline constexpr std::uint32_t kSensorPrearmCheck = 0x10000000;
// GPS_FIX_TYPE
inline constexpr std::uint8_t kNoFix = 1, kFix3d = 3, kFixDgps = 4, kRtkFloat = 5, kRtkFixed = 6;
/// @param mode  of GnssFix: 2 with corrections from satellites, 3 float, 4 fixed
constexpr std::uint8_t fix_type(bool is_valid, int mode) {
  if (!is_valid) return kNoFix;
  return mode == 2 ? kFixDgps : mode == 3 ? kRtkFloat : mode == 4 ? kRtkFixed : kFix3d;
}
// EKF_STATUS_FLAGS: it knows where it is on Earth
inline constexpr std::uint16_t kEkfKnowsPlace = 16;
// MAV_CMD of commands; those of mission items are in engine/io/missions/mav_command.h
inline constexpr std::uint16_t kCommandSetMode = 176, kCommandPauseContinue = 193,
                               kCommandGetHome = 410, kCommandRequestCapabilities = 520,
                               kCommandMissionStart = 300, kCommandArm = 400,
                               kCommandSetMessageInterval = 511, kCommandRequestMessage = 512;
// MAV_PARAM_TYPE
inline constexpr std::uint8_t kParameterUint32 = 5, kParameterInt32 = 6, kParameterReal32 = 9;
// MAV_RESULT
inline constexpr std::uint8_t kResultAccepted = 0, kResultTemporarilyRejected = 1,
                              kResultDenied = 2, kResultUnsupported = 3, kResultFailed = 4,
                              kResultInProgress = 5;
// MAV_MISSION_RESULT
inline constexpr std::uint8_t kMissionAccepted = 0, kMissionUnsupported = 3, kMissionNoSpace = 4,
                              kMissionInvalid = 5, kMissionInvalidSequence = 13,
                              kMissionDenied = 14;

/// Words for a MAV_MISSION_RESULT.
constexpr const char* mission_result_name(std::uint8_t result) {
  switch (result) {
    case kMissionAccepted:
      return "accepted";
    case kMissionNoSpace:
      return "it has no room for it";
    case kMissionInvalid:
      return "an item is invalid";
    case kMissionInvalidSequence:
      return "an item came out of order";
    case kMissionDenied:
      return "it takes no missions from here";
    default:
      return "without a reason";
  }
}

}  // namespace vinerow::mavlink
