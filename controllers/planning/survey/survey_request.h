#pragma once
/// What is asked of a survey, and whether a camera and an aircraft can do it at all.

#include <optional>
#include <string>

#include "controllers/planning/survey/survey_area.h"
#include "engine/api/survey_camera.h"
#include "engine/math/pose.h"

namespace vinerow::controllers {

inline constexpr double kMmPerM = 1e3;

struct SurveyRequest {
  Polygon2 polygon_W;  ///< cleaned
  SurveyCamera camera;
  double height_m = 150.0;  ///< above the ground
  double forward_overlap = 0.85;
  double side_overlap = 0.66;
  double speed_mps = 12.0;             ///< through the air; of rotorcraft over ground
  bool rotorcraft = false;             ///< stops at corners, climbs straight up, holds its speed
                                       ///< over ground in wind
  Eigen::Vector2d wind_W = {0, 0};     ///< where it blows to
  std::optional<double> lane_yaw_rad;  ///< absent: the direction of the fewest lanes
  enum class Order { kBest, kSnake } order = Order::kBest;
  double bank_rad = 0.6;         ///< in turns
  double least_radius_m = 0.0;   ///< of the aircraft; turns are not tighter
  double stall_speed_mps = 0.0;  ///< 0: not known
  double ramp_error_m = 2.0;
  double max_slope = 0.12;
  std::optional<double> run_out_m;  ///< straight on beyond the pictures, before and after turns;
                                    ///< absent: turn radius and two seconds
  double end_margin = 0.5;          ///< see LaneNeeds
  double edge_margin = 0.0;         ///< see LaneNeeds
  bool returns = true;
  double gravity_mps2 = 9.80665;
};

/// Speed over ground along a direction, crabbing. @param along_W unit
/// @returns nullopt where the wind is too strong for that
std::optional<double> calc_ground_speed_mps(double airspeed_mps, const Eigen::Vector2d& wind_W,
                                            const Eigen::Vector2d& along_W);

/// Radius over ground that holds with the wind from behind: (V + W)^2 / (g tan(bank)); not less
/// than the aircraft's. 0 of rotorcraft, which turn on the spot.
double calc_turn_radius_m(const SurveyRequest& request);

/// What keeps it from being flown whatever the terrain: the polygon, a speed below stall, wind, or
/// a camera that is too slow for speed, overlap and height (paper A's reference, section 2: V <=
/// (1 - q) h l / f times the rate). @returns one sentence with the numbers that would work
std::optional<std::string> find_survey_fault(const SurveyRequest& request, double lane_yaw_rad);

}  // namespace vinerow::controllers
