#pragma once
/// Planner of a whole mission on the occupancy grid: legs along the alleys, and a PoseSearch for
/// the way to the first alley and for every turn (paper A, section 4.1). Same for every search.

#include <memory>
#include <optional>

#include "controllers/planning/routes/row_route.h"
#include "controllers/planning/search/pose_search.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

struct RoutePlannerParams {
  RowRouteParams route;
  std::optional<double> wanted_radius_m;  ///< absent: the vehicle's own
  double turning_radius_m = 0.0;          ///< least of the vehicle, or the one wanted
  double margin_m = 0.05;                 ///< room around the footprint
  double pitch_m = 0.25;                  ///< of the waypoints
  double speed_mps = 0.0;                 ///< on legs; 0 = the follower's own
  double turn_speed_mps = 0.0;
  double check_step_m = 0.1;  ///< between poses of the swept check
};

/// Parameters that every route planner has: those of row_route.h, beyond_m, turning_radius_m,
/// margin_m, waypoint_pitch_m, speed_mps, turn_speed_mps.
const ParameterTable<RoutePlannerParams>& route_planner_table();
/// The turning radius is the parameter's, else the vehicle's min_turning_radius_m.
/// @throws ConfigError for alleys the map does not have, a vehicle without turning radius, or one
/// that cannot turn so tightly
RoutePlannerParams read_route_planner_params(const ParameterSet& parameters,
                                             const PlannerContext& context, const std::string& who);
/// The same where an outer table has read the parameters: checks the alleys, fills in the turning
/// radius.
void complete_route_params(const PlannerContext& context, const std::string& who,
                           RoutePlannerParams& params);

/// Refuses, each with one sentence and the numbers: a start in collision, a leg or its end inside
/// a row, a turn for which there is no room (with the clearance that is missing).
/// Reports "nodes", "iterations", "turns", "length_m" of the path, "turn_length_m" of its turns,
/// "first_turn_length_m" of the turns before the search improved them (only where it did),
/// "clearance_m" and "turn_clearance_m", the least room around the outline anywhere and in turns.
/// After a failure the numbers are of the work done until then.
/// @param context  its map and vehicle must outlive the planner
/// @throws ConfigError if the map has no alleys or no grid
std::unique_ptr<Planner> make_route_planner(const RoutePlannerParams& params,
                                            std::unique_ptr<PoseSearch> search,
                                            const PlannerContext& context);

/// How much farther away on every side everything would have to be, m, for a turn between two poses
/// to fit at the turning radius: 0 where it fits. What lies behind a wall counts as taken. Looks at
/// Dubins paths only, so that a search may still find a way where this is > 0. nullopt if the ends
/// themselves are taken or no free ground joins them near by. For refusals.
std::optional<double> calc_missing_clearance_m(const Pose2& from, const Pose2& to, double radius_m,
                                               const DistanceField& field,
                                               const std::vector<Eigen::Vector2d>& outline_B,
                                               double margin_m);

}  // namespace vinerow::controllers
