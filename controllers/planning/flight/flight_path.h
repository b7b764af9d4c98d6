#pragma once
/// Horizontal path of a flying vehicle over the row map: that of the ground planners, from the
/// take-off along the alleys to the end of the last one, with a free choice of the first heading.

#include <functional>
#include <memory>

#include "controllers/planning/flight/flight_heights.h"
#include "controllers/planning/routes/headland_turn.h"
#include "controllers/planning/routes/route_planner.h"
#include "controllers/planning/search/pose_search.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

class RowPathPlanner {
 public:
  virtual ~RowPathPlanner() = default;
  /// @param start  place of the take-off; the vehicle can turn to any heading while it climbs
  /// @returns points on the ground of kinds kTransit, kLeg, kTurn, or the reason why there is no
  /// path
  virtual Result<PlannedPath> plan(const Eigen::Vector3d& start_W) = 0;
  virtual const PlanReport* report() const = 0;
};

/// Path with turns searched on the occupancy grid by the route planner of ground vehicles.
/// @throws ConfigError if the map has no grid
std::unique_ptr<RowPathPlanner> make_grid_path(const RoutePlannerParams& params,
                                               std::unique_ptr<PoseSearch> search,
                                               const PlannerContext& context);

/// Path with turns in closed form, for maps without a grid; avoids canopies only.
/// @param reach_m  half the width that the vehicle needs, margin included
std::unique_ptr<RowPathPlanner> make_closed_form_path(const RoutePlannerParams& params,
                                                      TurnKind turns, double reach_m,
                                                      const PlannerContext& context);

/// The heading with the shortest Dubins path to the entrance of the first alley. @param is_free
/// called for candidate paths; if none is free, the shortest path is chosen
double choose_heading(const Eigen::Vector2d& start, const RouteLeg& first, double radius_m,
                      const std::function<bool(const std::vector<PathSegment>&)>& is_free);

}  // namespace vinerow::controllers
