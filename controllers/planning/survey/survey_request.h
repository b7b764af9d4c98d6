#pragma once
/// Request for a survey, and the check of whether camera and aircraft can fly it.

#include <optional>
#include <string>

#include "engine/math/polygon.h"
#include "engine/api/survey_camera.h"
#include "engine/math/pose.h"

namespace vinerow::controllers {

inline constexpr double kMmPerM = 1e3;

struct SurveyRequest {
  Polygon polygon_W;  ///< cleaned
  SurveyCamera camera;
  double height_m = 150.0;  ///< above the ground
  double forward_overlap = 0.85;
  double side_overlap = 0.66;
  double speed_mps = 12.0;             ///< through the air; of rotorcraft over ground
  bool rotorcraft = false;             ///< stops at corners, climbs straight up, holds its speed
                                       ///< over ground in wind
  Eigen::Vector2d wind_W = {0, 0};     ///< direction to which it blows
  std::optional<double> lane_yaw_rad;  ///< absent: the direction of the fewest lanes
  enum class Order { kBest, kSnake } order = Order::kBest;
  double bank_rad = 0.6;         ///< in turns
  double min_radius_m = 0.0;     ///< minimum of the aircraft
  double stall_speed_mps = 0.0;  ///< 0: unknown
  double ramp_error_m = 2.0;
  double max_slope = 0.12;
  std::optional<double> run_out_m;  ///< straight flight beyond the pictures, before and after
                                    ///< turns; absent: turn radius plus two seconds
  double end_margin = 0.5;          ///< see LaneNeeds
  double edge_margin = 0.0;         ///< see LaneNeeds
  bool returns = true;
  double gravity_mps2 = 9.80665;
};

/// Speed over ground along a direction with a crab angle. @param along_W unit @returns nullopt if
/// the wind is too strong
std::optional<double> calc_ground_speed_mps(double airspeed_mps, const Eigen::Vector2d& wind_W,
                                            const Eigen::Vector2d& along_W);

/// Turn radius over ground with the wind from behind: (V + W)^2 / (g tan(bank)), at least the
/// aircraft's minimum. 0 for rotorcraft, which turn on the spot.
double calc_turn_radius_m(const SurveyRequest& request);

/// Fault that makes a survey impossible over any terrain: the polygon, a speed below stall, wind,
/// or a camera that is too slow for speed, overlap and height (paper A's reference, section 2: V <=
/// (1 - q) h l / f times the rate). @returns one sentence with numbers that would work
std::optional<std::string> find_survey_fault(const SurveyRequest& request, double lane_yaw_rad);

}  // namespace vinerow::controllers
