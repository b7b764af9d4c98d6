#pragma once
/// The mission commands and frames of MAVLink that are known here, with what they mean for a
/// flight.
///
/// Source: MAVLink, common.xml, enums MAV_CMD and MAV_FRAME (numbers and names).

#include <string>

namespace vinerow::io {

/// What becomes of a mission command when its mission is flown.
enum class MavAction {
  kWaypoint,  ///< fly there
  kLoiter,    ///< fly there; the circles are left out
  kReturn,    ///< fly home
  kLand,      ///< fly there and land
  kTakeOff,
  kSpeed,          ///< sets the speed of what follows
  kTrigger,        ///< camera trigger by distance: on where parameter 1 > 0
  kNoMotion,       ///< camera, gimbal, relays and the like: the flight is the same without
  kCannotBeFlown,  ///< changes the flight in a way that is not supported
};

struct MavCommand {
  int number = 0;
  const char* name = "";  ///< without MAV_CMD_
  MavAction action = MavAction::kNoMotion;
};

/// @returns null where the number is not known
const MavCommand* find_mav_command(int number);
/// "16 NAV_WAYPOINT", or the bare number where it is not known.
std::string describe_mav_command(int number);

/// What an item's altitude is measured from.
enum class MavAltitude { kMeanSeaLevel, kHome, kTerrain, kNone };
/// MAV_FRAME. @returns false where the frame is not one of 0, 2, 3, 5, 6, 10, 11
bool find_mav_altitude(int frame, MavAltitude& altitude);

}  // namespace vinerow::io
