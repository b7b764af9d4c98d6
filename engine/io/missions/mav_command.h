#pragma once
/// Supported mission commands and frames of MAVLink, with their effect on a flight.
///
/// Source: MAVLink, common.xml, enums MAV_CMD and MAV_FRAME (numbers and names).

#include <string>

namespace vinerow::io {

// Commands that are written, and frames (MAV_FRAME).
inline constexpr int kNavWaypoint = 16, kNavReturn = 20, kNavLand = 21, kNavTakeOff = 22,
                     kDoChangeSpeed = 178, kDoSetCameraTriggerDistance = 206;
inline constexpr int kFrameMeanSeaLevel = 0, kFrameMission = 2, kFrameHome = 3, kFrameTerrain = 10;

/// Effect of a mission command on the flight.
enum class MavAction {
  kWaypoint,  ///< fly there
  kLoiter,    ///< fly there; the circles are ignored
  kReturn,    ///< fly home
  kLand,      ///< fly there and land
  kTakeOff,
  kSpeed,          ///< sets the speed of the following items
  kTrigger,        ///< camera trigger by distance: on if parameter 1 > 0
  kNoMotion,       ///< camera, gimbal, relays and similar: no effect on the flight
  kCannotBeFlown,  ///< affects the flight in an unsupported way
};

struct MavCommand {
  int number = 0;
  const char* name = "";  ///< without MAV_CMD_
  MavAction action = MavAction::kNoMotion;
};

/// @returns null if the number is unknown
const MavCommand* find_mav_command(int number);
/// "16 NAV_WAYPOINT", or only the number if it is unknown.
std::string describe_mav_command(int number);

/// Reference of an item's altitude.
enum class MavAltitude { kMeanSeaLevel, kHome, kTerrain, kNone };
/// Altitude reference of a MAV_FRAME. @returns false if the frame is not one of 0, 2, 3, 5, 6, 10,
/// 11
bool find_mav_altitude(int frame, MavAltitude& altitude);

}  // namespace vinerow::io
