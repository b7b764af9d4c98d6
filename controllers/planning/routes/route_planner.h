#pragma once
/// Planner of a whole mission on the occupancy grid: legs along the alleys, and a PoseSearch for
/// the path to the first alley and for every turn (paper A, section 4.1). Common to all searches.

#include <memory>
#include <optional>

#include "controllers/planning/routes/row_route.h"
#include "controllers/planning/search/pose_search.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

struct RoutePlannerParams {
  RowRouteParams route;
  std::optional<double> wanted_radius_m;  ///< absent: the vehicle's own
  double turning_radius_m = 0.0;          ///< minimum of the vehicle, or the one wanted
  double margin_m = 0.05;                 ///< clearance around the footprint
  double pitch_m = 0.25;                  ///< of the waypoints
  double speed_mps = 0.0;                 ///< on legs; 0 = the follower's own
  double turn_speed_mps = 0.0;
  double check_step_m = 0.1;  ///< between poses of the collision check
};

/// Common parameters of route planners: those of row_route.h, beyond_m, turning_radius_m, margin_m,
/// waypoint_pitch_m, speed_mps, turn_speed_mps.
const ParameterTable<RoutePlannerParams>& route_planner_table();
/// The turning radius is the parameter, else the vehicle's min_turning_radius_m. @throws
/// ConfigError for alleys that the map does not have, a vehicle without turning radius, or one that
/// cannot turn so tightly
RoutePlannerParams read_route_planner_params(const ParameterSet& parameters,
                                             const PlannerContext& context, const std::string& who);
/// The same for parameters that an outer table has read: checks the alleys and sets the turning
/// radius.
void complete_route_params(const PlannerContext& context, const std::string& who,
                           RoutePlannerParams& params);

/// Fails, with one sentence and the numbers, on a start in collision, a leg or its end inside a
/// row, or a turn without enough space (with the missing clearance). Reports "nodes", "iterations",
/// "turns", "length_m" of the path, "turn_length_m" of its turns, "first_turn_length_m" of the
/// turns before the search improved them (only if it did), "clearance_m" and "turn_clearance_m",
/// the minimum clearance around the outline on the whole path and in turns. After a failure the
/// numbers describe the work done until then.
/// @param context  its map and vehicle must outlive the planner
/// @param field    of the map's occupancy, if the caller has it already
/// @throws ConfigError if the map has no alleys or no grid
std::unique_ptr<Planner> make_route_planner(const RoutePlannerParams& params,
                                            std::unique_ptr<PoseSearch> search,
                                            const PlannerContext& context,
                                            std::shared_ptr<const DistanceField> field = nullptr);

/// Adds "nodes", "iterations" and the tree of a search, at height 0, to the report of a planner.
void add_search(const SearchReport& done, PlanReport& report);

inline constexpr double kClearanceReach_m = 10.0;  ///< around both ends

/// Distance, m, by which all obstacles would have to be farther away for a turn between two poses
/// to fit at the turning radius; 0 if it fits. Ground behind a wall counts as occupied. Considers
/// Dubins paths only, so that a search may still find a path if this is > 0. nullopt if the ends
/// themselves are occupied or no free ground connects them nearby; kClearanceReach_m or more if
/// every turn leaves the surroundings of both ends, however far it leads. For error messages.
std::optional<double> calc_missing_clearance_m(const Pose2& from, const Pose2& to, double radius_m,
                                               const DistanceField& field,
                                               const std::vector<Eigen::Vector2d>& outline_B,
                                               double margin_m);

}  // namespace vinerow::controllers
