#pragma once
/// Planner `mission_file` for ground vehicles: a ground station's mission driven from place to
/// place, around its fences, at its speeds, with the sprayer where its items say.

#include <memory>
#include <optional>
#include <string>

#include "engine/api/stepped_parts.h"
#include "engine/io/missions/mission_file.h"

namespace vinerow::controllers {

struct GroundMissionParams {
  bool keeps_fences = true;
  double pitch_m = 0.33;
  std::optional<double> turning_radius_m;  ///< absent: what the vehicle needs
};

/// Heights count for nothing; take-off and landing are places like others, or none. Reports
/// "items", "waypoints", "length_m", "ignored_items", "loiters" (driven as waypoints),
/// "fence_detours", "rounded_corners", "loops_at_corners".
/// @throws ConfigError as make_mission_route()
std::unique_ptr<Planner> make_ground_mission(const io::MissionFile& mission,
                                             const GroundMissionParams& params,
                                             const PlannerContext& context, const std::string& who);

}  // namespace vinerow::controllers
