#pragma once
/// Planner `mission_file` for ground vehicles: drives a ground station's mission from place to
/// place, around its fences, at its speeds, and switches the sprayer as its items command.

#include <memory>
#include <optional>
#include <string>

#include "engine/api/stepped_parts.h"
#include "engine/io/missions/mission_file.h"

namespace vinerow::controllers {

struct GroundMissionParams {
  bool keeps_fences = true;
  double pitch_m = 0.33;
  std::optional<double> turning_radius_m;  ///< absent: from the vehicle
};

/// Ignores heights. Take-off and landing are ordinary places if they have a position. Reports
/// "items", "waypoints", "length_m", "ignored_items", "loiters" (driven as waypoints),
/// "fence_detours", "rounded_corners", "loops_at_corners".
/// @throws ConfigError as make_mission_route()
std::unique_ptr<Planner> make_ground_mission(const io::MissionFile& mission,
                                             const GroundMissionParams& params,
                                             const PlannerContext& context, const std::string& who);

}  // namespace vinerow::controllers
