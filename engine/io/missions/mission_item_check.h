#pragma once
/// Checks and error messages shared by the mission formats.

#include <string>

#include "engine/io/missions/mission_file.h"

namespace vinerow::io {

/// "mission 'a.plan', item 3"
std::string mission_place(const std::filesystem::path& file, int number);

/// @throws ConfigError for an unknown command or frame, and for an invalid position
void check_mission_item(const MissionItem& item, const std::filesystem::path& file);

}  // namespace vinerow::io
