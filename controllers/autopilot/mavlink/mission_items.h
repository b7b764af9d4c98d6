#pragma once
/// Items of a mission as an autopilot gets them.

#include <vector>

#include "controllers/autopilot/frames/firmware_frame.h"
#include "engine/io/missions/mission_file.h"
#include "engine/mavlink/messages.h"

namespace vinerow::controllers {

/// @param has_home  ArduPilot's missions begin with home, which is their item 0
/// @returns items with their numbers; places as the firmware has them, so that the vehicle reaches
/// the places of the mission in the world
std::vector<mavlink::MissionItemInt> make_mission_items(const io::MissionFile& mission,
                                                        const FirmwareFrame& frame, bool has_home);

}  // namespace vinerow::controllers
