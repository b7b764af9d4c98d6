#include "engine/io/missions/mav_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace vinerow::io {
namespace {

using enum MavAction;

// In the order of their numbers.
constexpr std::array kCommands = {
    MavCommand{kNavWaypoint, "NAV_WAYPOINT", kWaypoint},
    MavCommand{17, "NAV_LOITER_UNLIM", kLoiter},
    MavCommand{18, "NAV_LOITER_TURNS", kLoiter},
    MavCommand{19, "NAV_LOITER_TIME", kLoiter},
    MavCommand{kNavReturn, "NAV_RETURN_TO_LAUNCH", kReturn},
    MavCommand{kNavLand, "NAV_LAND", kLand},
    MavCommand{kNavTakeOff, "NAV_TAKEOFF", kTakeOff},
    MavCommand{30, "NAV_CONTINUE_AND_CHANGE_ALT", kCannotBeFlown},
    MavCommand{31, "NAV_LOITER_TO_ALT", kLoiter},
    MavCommand{80, "NAV_ROI", kNoMotion},
    MavCommand{82, "NAV_SPLINE_WAYPOINT", kWaypoint},
    MavCommand{84, "NAV_VTOL_TAKEOFF", kCannotBeFlown},
    MavCommand{85, "NAV_VTOL_LAND", kCannotBeFlown},
    MavCommand{92, "NAV_GUIDED_ENABLE", kCannotBeFlown},
    MavCommand{93, "NAV_DELAY", kCannotBeFlown},
    MavCommand{94, "NAV_PAYLOAD_PLACE", kCannotBeFlown},
    MavCommand{112, "CONDITION_DELAY", kNoMotion},
    MavCommand{113, "CONDITION_CHANGE_ALT", kCannotBeFlown},
    MavCommand{114, "CONDITION_DISTANCE", kNoMotion},
    MavCommand{115, "CONDITION_YAW", kNoMotion},
    MavCommand{176, "DO_SET_MODE", kCannotBeFlown},
    MavCommand{177, "DO_JUMP", kCannotBeFlown},
    MavCommand{kDoChangeSpeed, "DO_CHANGE_SPEED", kSpeed},
    MavCommand{179, "DO_SET_HOME", kCannotBeFlown},
    MavCommand{181, "DO_SET_RELAY", kNoMotion},
    MavCommand{182, "DO_REPEAT_RELAY", kNoMotion},
    MavCommand{183, "DO_SET_SERVO", kNoMotion},
    MavCommand{184, "DO_REPEAT_SERVO", kNoMotion},
    MavCommand{189, "DO_LAND_START", kNoMotion},
    MavCommand{195, "DO_SET_ROI_LOCATION", kNoMotion},
    MavCommand{196, "DO_SET_ROI_WPNEXT_OFFSET", kNoMotion},
    MavCommand{197, "DO_SET_ROI_NONE", kNoMotion},
    MavCommand{200, "DO_CONTROL_VIDEO", kNoMotion},
    MavCommand{201, "DO_SET_ROI", kNoMotion},
    MavCommand{202, "DO_DIGICAM_CONFIGURE", kNoMotion},
    MavCommand{203, "DO_DIGICAM_CONTROL", kNoMotion},
    MavCommand{204, "DO_MOUNT_CONFIGURE", kNoMotion},
    MavCommand{205, "DO_MOUNT_CONTROL", kNoMotion},
    MavCommand{kDoSetCameraTriggerDistance, "DO_SET_CAM_TRIGG_DIST", kTrigger},
    MavCommand{207, "DO_FENCE_ENABLE", kNoMotion},
    MavCommand{208, "DO_PARACHUTE", kCannotBeFlown},
    MavCommand{211, "DO_GRIPPER", kNoMotion},
    MavCommand{214, "DO_SET_CAM_TRIGG_INTERVAL", kNoMotion},
    MavCommand{216, "DO_SPRAYER", kNoMotion},
    MavCommand{222, "DO_GUIDED_LIMITS", kCannotBeFlown},
    MavCommand{530, "SET_CAMERA_MODE", kNoMotion},
    MavCommand{531, "SET_CAMERA_ZOOM", kNoMotion},
    MavCommand{532, "SET_CAMERA_FOCUS", kNoMotion},
    MavCommand{1000, "DO_GIMBAL_MANAGER_PITCHYAW", kNoMotion},
    MavCommand{2000, "IMAGE_START_CAPTURE", kNoMotion},
    MavCommand{2001, "IMAGE_STOP_CAPTURE", kNoMotion},
    MavCommand{2003, "DO_TRIGGER_CONTROL", kNoMotion},
    MavCommand{2500, "VIDEO_START_CAPTURE", kNoMotion},
    MavCommand{2501, "VIDEO_STOP_CAPTURE", kNoMotion},
    MavCommand{3000, "DO_VTOL_TRANSITION", kCannotBeFlown},
};

}  // namespace

const MavCommand* find_mav_command(int number) {
  const auto found =
      std::lower_bound(kCommands.begin(), kCommands.end(), number,
                       [](const MavCommand& command, int n) { return command.number < n; });
  return found != kCommands.end() && found->number == number ? &*found : nullptr;
}

std::string describe_mav_command(int number) {
  const MavCommand* command = find_mav_command(number);
  return command ? fmt::format("{} {}", number, command->name) : std::to_string(number);
}

bool find_mav_altitude(int frame, MavAltitude& altitude) {
  switch (frame) {
    case 0:  // GLOBAL
    case 5:  // GLOBAL_INT
      altitude = MavAltitude::kMeanSeaLevel;
      return true;
    case 2:  // MISSION: the item has no position
      altitude = MavAltitude::kNone;
      return true;
    case 3:  // GLOBAL_RELATIVE_ALT
    case 6:  // GLOBAL_RELATIVE_ALT_INT
      altitude = MavAltitude::kHome;
      return true;
    case 10:  // GLOBAL_TERRAIN_ALT
    case 11:  // GLOBAL_TERRAIN_ALT_INT
      altitude = MavAltitude::kTerrain;
      return true;
    default:
      return false;
  }
}

}  // namespace vinerow::io
