#pragma once
/// Planner of a whole mission on the occupancy grid: legs along the alleys, and a PoseSearch for
/// the way to the first alley and for every turn (paper A, section 4.1). Same for every search.

#include <memory>

#include "controllers/planning/pose_search.h"
#include "controllers/planning/row_route.h"
#include "engine/api/stepped_parts.h"

namespace vinerow {

struct RoutePlannerParams {
  RowRouteParams route;
  double margin_m = 0.05;  ///< room around the footprint
  double pitch_m = 0.25;   ///< of the waypoints
  double speed_mps = 0.0;  ///< on legs; 0 = the follower's own
  double turn_speed_mps = 0.0;
  double check_step_m = 0.1;  ///< between poses of the swept check
};

/// Parameters that every route planner has: alleys, order, margin_m, waypoint_pitch_m, speed_mps,
/// turn_speed_mps, beyond_m, straighten_m.
std::vector<ParameterSpec> route_planner_parameters();
/// @throws ConfigError for alleys the map does not have
RoutePlannerParams read_route_planner_params(const ParameterSet& parameters,
                                             const PlannerContext& context, const std::string& who);

/// Refuses, each with one sentence and the numbers: a map without grid, a start in collision, a leg
/// or goal inside a row, a turn for which there is no room (with the clearance that is missing).
/// Reports "nodes", "iterations", "length_m", "clearance_m", "turn_clearance_m", "turns".
/// @throws ConfigError if the map has no alleys or no grid
std::unique_ptr<Planner> make_route_planner(const RoutePlannerParams& params,
                                            std::unique_ptr<PoseSearch> search,
                                            const PlannerContext& context);

/// How much the vehicle's outline would have to shrink on every side, m, for a turn between two
/// poses to fit at the turning radius: 0 where it fits, nullopt where even a tenth of its width
/// does not. For refusals.
std::optional<double> calc_missing_clearance_m(const Pose2& from, const Pose2& to, double radius_m,
                                               const DistanceField& field,
                                               const std::vector<Eigen::Vector2d>& outline_B,
                                               double margin_m);

}  // namespace vinerow
