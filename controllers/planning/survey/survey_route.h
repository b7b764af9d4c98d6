#pragma once
/// Horizontal path of a survey: to the first lane, along lanes and turns, home.

#include <optional>
#include <vector>

#include "controllers/planning/survey/survey_lanes.h"
#include "controllers/planning/survey/survey_order.h"
#include "engine/api/messages/path.h"

namespace vinerow::controllers {

/// A corner of the path; `kind` and `lane` are those of the straight that starts here.
struct RoutePoint {
  Eigen::Vector2d p_W = {0, 0};
  PathKind kind = PathKind::kTransit;
  int lane = -1;
};

struct SurveyRoute {
  std::vector<RoutePoint> points;
  std::size_t first_lane_point = 0;  ///< index of the point where the first lane's run-in starts
  int wide_turns = 0;
};

struct RouteTask {
  Eigen::Vector2d start_W = {0, 0};
  bool returns = true;
  double run_out_m = 45.0;
  double turn_radius_m = 25.0;
};

/// @param order  of the lanes, see order_lanes()
SurveyRoute make_survey_route(const RouteTask& task, const LaneFrame& frame,
                              const std::vector<SurveyLane>& lanes, const LaneOrder& order);

/// Corners of a path from a place to a lane that can all be flown with the turn radius: the
/// distance between two corners is enough for both turns (R tan(angle / 2) each). The shortest of
/// some dozens of candidates; if none fits, the one that misses least.
/// @param heading_W  unit, direction of arrival at `from_W`; absent: any
/// @param to_W       start of the lane  @param along_W  unit, of the lane
std::vector<Eigen::Vector2d> find_approach(const Eigen::Vector2d& from_W,
                                           const std::optional<Eigen::Vector2d>& heading_W,
                                           const Eigen::Vector2d& to_W,
                                           const Eigen::Vector2d& along_W, double turn_radius_m);

/// Corners of laps near the start that make the path to `target` at least `min_length_m` long:
/// first straight ahead along `yaw_rad`, then round to the left or right.
std::vector<Eigen::Vector2d> make_climb_laps(const Eigen::Vector2d& start_W, double yaw_rad,
                                             const Eigen::Vector2d& target_W, double min_length_m,
                                             double turn_radius_m, bool to_left);

}  // namespace vinerow::controllers
