#pragma once
/// Reader and writer of the text format `QGC WPL 110` of Mission Planner and others: one item per
/// line, twelve fields separated by tabs.
///
/// Source: MAVLink developer guide, "File Formats". A waypoint above mean sea level in the first
/// line is home, as in Mission Planner and QGroundControl.

#include <filesystem>
#include <string>

#include "engine/io/missions/mission_file.h"

namespace vinerow::io {

/// The last line needs no newline; fields may be separated by any blanks. @throws ConfigError, see
/// read_mission
MissionFile parse_qgc_wpl(const std::string& text, const std::filesystem::path& file);

/// The mission as text, with home in the first line. @pre mission.planned_home
std::string format_qgc_wpl(const MissionFile& mission);
/// @throws ConfigError if the file cannot be written
void write_qgc_wpl(const MissionFile& mission, const std::filesystem::path& file);

}  // namespace vinerow::io
