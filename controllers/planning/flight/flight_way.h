#pragma once
/// The way of a flying vehicle over the row map seen from above: that of the ground planners, from
/// where it took off, with the heading it likes, along the alleys to the end of the last.

#include <functional>
#include <memory>

#include "controllers/planning/flight/flight_heights.h"
#include "controllers/planning/routes/headland_turn.h"
#include "controllers/planning/routes/route_planner.h"
#include "controllers/planning/search/pose_search.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

class FlightWay {
 public:
  virtual ~FlightWay() = default;
  /// @param start  place of the take-off; the vehicle turns to any heading while it climbs
  /// @returns points on the ground of kinds kTransit, kLeg, kTurn; or why there is no way
  virtual Result<PlannedPath> plan(const Eigen::Vector3d& start_W) = 0;
  virtual const PlanReport* report() const = 0;
};

/// Turns searched on the occupancy grid, by the route planner of ground vehicles.
/// @throws ConfigError if the map has no grid
std::unique_ptr<FlightWay> make_grid_way(const RoutePlannerParams& params,
                                         std::unique_ptr<PoseSearch> search,
                                         const PlannerContext& context);

/// Turns in closed form, for maps without a grid; looks at canopies only.
/// @param reach_m  half the width that the vehicle needs, margin included
std::unique_ptr<FlightWay> make_closed_form_way(const RoutePlannerParams& params, TurnKind turns,
                                                double reach_m, const PlannerContext& context);

/// The heading from which the entrance of the first alley is nearest along a Dubins path.
/// @param is_free  asked for every way that comes into question; where none is free the nearest
///                 counts
double choose_heading(const Eigen::Vector2d& start, const RouteLeg& first, double radius_m,
                      const std::function<bool(const std::vector<PathPiece>&)>& is_free);

}  // namespace vinerow::controllers
