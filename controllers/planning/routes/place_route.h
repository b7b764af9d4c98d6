#pragma once
/// Path from a pose past given places, around the obstacles on a map: of the planner `go_to`, and
/// of goals from outside.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "controllers/parts/paths/distance_field.h"
#include "controllers/parts/paths/footprint.h"
#include "controllers/planning/routes/route_clearance.h"
#include "controllers/planning/search/rrt_quartile.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

struct PlaceRouteParams {
  std::optional<double> turning_radius_m;  ///< absent: the vehicle's own
  double margin_m = 0.05;                  ///< clearance around the outline
  double pitch_m = 0.33;                   ///< of the waypoints
  double speed_mps = 0.0;                  ///< 0 = the follower's own
  std::int64_t max_iterations = 1'000'000;
};

/// turning_radius_m, margin_m, waypoint_pitch_m, speed_mps, max_iterations.
const ParameterTable<PlaceRouteParams>& place_route_table();

/// Each piece is a Dubins path if one is free, else the shortened result of the quartile tree on
/// the occupancy grid (rrt_quartile.h). The same call gives the same bits.
class PlaceRoute {
 public:
  /// @param vehicle,map  outlive this object
  /// @param who  for errors, "rover.planner (go_to)"
  /// @throws ConfigError if the map has no grid, or if the vehicle cannot turn so tightly
  PlaceRoute(const PlaceRouteParams& params, const VehicleDescription& vehicle, const RowMap* map,
             const PartContext& context, const std::string& who);

  /// Headings of intermediate places follow from their neighbours.
  /// @param places  in W, m; at least one
  /// @param end_yaw_rad  at the last place, counter-clockwise from east; absent: the direction of
  ///   arrival
  /// @param ground  lifts the points
  /// @returns the path, or the reason for the failure
  Result<PlannedPath> find(const Pose& start, const std::vector<Eigen::Vector2d>& places,
                           std::optional<double> end_yaw_rad, const SceneQuery* ground);
  /// Of the last find(): "nodes", "iterations", "length_m", "clearance_m", and the search tree.
  const PlanReport& report() const { return report_; }

 private:
  std::vector<Pose2> find_poses(const Pose2& start, const std::vector<Eigen::Vector2d>& places,
                                std::optional<double> end_yaw_rad) const;
  double find_free_yaw(const Eigen::Vector2d& p, double wanted_rad) const;
  Result<PathSegments> join(const Pose2& from, const Pose2& to, int problem);
  void measure(const PathSegments& pieces);

  PlaceRouteParams params_;
  double radius_m_;
  RrtQuartile search_;
  const RowMap& map_;
  DistanceField field_;
  Footprint footprint_;
  RouteClearance clearance_;
  PlanReport report_;
};

}  // namespace vinerow::controllers
