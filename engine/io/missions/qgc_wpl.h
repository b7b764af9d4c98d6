#pragma once
/// The text format `QGC WPL 110` of Mission Planner and others: one item a line, twelve fields
/// between tabs.
///
/// Source: MAVLink developer guide, "File Formats". A first line that is a waypoint above mean sea
/// level is home: Mission Planner and QGroundControl write and read it so.

#include <filesystem>
#include <string>

#include "engine/io/missions/mission_file.h"

namespace vinerow::io {

/// The last line needs no newline; fields may be parted by any blanks. @throws ConfigError, see
/// read_mission
MissionFile parse_qgc_wpl(const std::string& text, const std::filesystem::path& file);

/// With home in the first line. @pre mission.planned_home
std::string format_qgc_wpl(const MissionFile& mission);
/// @throws ConfigError if the file cannot be written
void write_qgc_wpl(const MissionFile& mission, const std::filesystem::path& file);

}  // namespace vinerow::io
