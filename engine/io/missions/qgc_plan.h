#pragma once
/// Reader and writer of QGroundControl's `.plan`: JSON with mission, fences and rally points.
///
/// Source: QGroundControl developer guide, "Plan File Format" (version 1, mission version 2, survey
/// version 5, fences version 2).

#include <filesystem>
#include <string>

#include "engine/io/missions/mission_file.h"

namespace vinerow::io {

/// Surveys are replaced by the items that QGroundControl computed from them
/// (TransectStyleComplexItem/Items). @throws ConfigError, see read_mission
MissionFile parse_qgc_plan(const std::string& text, const std::filesystem::path& file);

/// The mission as QGroundControl saves it, for a fixed-wing vehicle or a multirotor.
/// @pre mission.planned_home
std::string format_qgc_plan(const MissionFile& mission);
/// @throws ConfigError if the file cannot be written
void write_qgc_plan(const MissionFile& mission, const std::filesystem::path& file);

}  // namespace vinerow::io
