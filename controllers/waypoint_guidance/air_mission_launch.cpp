// Path to the plan: off the launcher, up in circles if it is short, to the first waypoint.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/aircraft/wind_triangle.h"
#include "controllers/waypoint_guidance/air_mission.h"

namespace vinerow::controllers {

void AirMission::launch(const GuidanceState& state) {
  stage_ = Stage::kLaunch;
  generator_.start(state.yaw_rad, state.bank_left_rad);
  height_.start(state.height_m);
  course_ = {state.yaw_rad, 0.0};
  report_event(false, fmt::format("launches on bearing {:.0f} deg for {:.0f} m of plan",
                                  bearing_deg(state.yaw_rad), length_m_));
}

void AirMission::join(const GuidanceState& state) {
  const LegFrame& frame = legs_.front().frame;
  const double along_m = frame.along_m(state.position);
  const double beyond_m = along_m - std::clamp(along_m, 0.0, frame.length_m());
  const double away_m = std::hypot(frame.left_m(state.position), beyond_m);
  is_launched_ = true;
  if (away_m > params_.join_m) {
    generator_.start(state.yaw_rad, state.bank_left_rad);
    height_.start(state.height_m);
    course_ = {unwrap_near(state.course_rad(), state.yaw_rad), 0.0};
    stage_ = Stage::kLaunch;
    report_event(
        false, fmt::format("is in the air, {:.0f} m from the plan's first leg: flies to its start",
                           away_m));
    return;
  }
  stage_ = Stage::kLegs;
  pilot_.start(legs_, 0, state, state.yaw_rad, false);
  const double course_rad = unwrap_near(frame.course_rad(), state.yaw_rad);
  course_ = {course_rad, 0.0};
  airspeed_mps_ = wanted_airspeed_mps_ = legs_.front().airspeed_mps;
  // The reference starts on the plan if the vehicle's distance from it is small enough to count as
  // a deviation; else it starts at the vehicle.
  constexpr double kDeviation_rad = 45.0 * kPi / 180.0, kDeviation_m = 20.0;
  const double heading_rad =
      course_rad + calc_crab(course_rad, state.wind, airspeed_mps_).angle_rad;
  const double height_m = calc_height(legs_, 0, along_m, params_.kink_m).height_m;
  const bool points_along = std::abs(heading_rad - state.yaw_rad) < kDeviation_rad;
  const bool is_level = std::abs(height_m - state.height_m) < kDeviation_m;
  generator_.start(points_along ? heading_rad : state.yaw_rad,
                   points_along ? 0.0 : state.bank_left_rad);
  height_.start(is_level ? height_m : state.height_m);
  report_event(false,
               fmt::format("is in the air, {:.1f} m from the plan's first leg: follows {:.0f} m",
                           away_m, length_m_));
}

AirMission::Wanted AirMission::fly_launch(const GuidanceState& state) {
  Wanted wanted = hold();
  is_launched_ = is_launched_ || state.height_m - launch_.height_m >= params_.launch_height_m;
  if (is_launched_) {
    // Straight ahead until the path to the plan can be flown: circles that it would not leave, or
    // that enclose the waypoint, are not started.
    const Eigen::Vector2d offset = goal_W_.head<2>() - state.position;
    const double course_rad = state.course_rad();
    const bool climbs = is_too_steep(state, 1.0);
    const double left_m = -std::sin(course_rad) * offset.x() + std::cos(course_rad) * offset.y();
    const double side = climbs ? params_.loiter_side : (left_m >= 0.0 ? 1.0 : -1.0);
    const double radius_m =
        climbs ? params_.loiter_radius_m : params_.legs.turn.radius_m(airspeed_mps_);
    const LoiterCircle circle = LoiterCircle::tangent(state.position, course_rad, radius_m, side);
    constexpr double kMargin = 1.4;
    if (circle.away_m(goal_W_.head<2>()) > kMargin * radius_m) {
      if (climbs) {
        circle_ = circle;
        stage_ = Stage::kClimb;
        report_event(false,
                     fmt::format("circles to climb from {:.0f} m until the path to the first "
                                 "waypoint at {:.0f} m can be flown",
                                 state.height_m, goal_W_.z()));
      } else {
        start_transit(state);
      }
    }
  }
  const double goal_m = std::max(goal_W_.z(), launch_.height_m + params_.launch_height_m);
  const Eigen::Vector2d along(std::cos(launch_.yaw_rad), std::sin(launch_.yaw_rad));
  const double slope = std::tan(params_.launch_climb_rad);
  const double flown_m = std::max(0.0, along.dot(state.position - launch_.position));
  wanted.height_m = launch_.height_m + slope * flown_m;
  wanted.rate_mps = slope * std::max(0.0, along.dot(state.velocity));
  if (wanted.height_m > goal_m) {
    wanted.height_m = goal_m;
    wanted.rate_mps = 0.0;
  }
  wanted.climb_max_rad = std::max(params_.launch_climb_rad, params_.legs.climb_max_rad);
  return wanted;
}

bool AirMission::is_too_steep(const GuidanceState& state, double share) const {
  const double distance_m = (goal_W_.head<2>() - state.position).norm();
  const double rise_m = goal_W_.z() - height_.height_m();
  return rise_m > share * distance_m * std::tan(params_.legs.climb_max_rad);
}

AirMission::Wanted AirMission::fly_climb(const GuidanceState& state) {
  Wanted wanted = hold();
  wanted.course = circle_.course(state, params_.pilot.cross_track_length_m, course_.course_rad);
  wanted.height_m = goal_W_.z();
  constexpr double kReserve = 0.9, kAhead_rad = 8.0 * kPi / 180.0;
  const Eigen::Vector2d offset = goal_W_.head<2>() - state.position;
  const double off_rad = wrap_angle(std::atan2(offset.y(), offset.x()) - state.course_rad());
  if (!is_too_steep(state, kReserve) && std::abs(off_rad) < kAhead_rad) start_transit(state);
  return wanted;
}

void AirMission::start_transit(const GuidanceState& state) {
  stage_ = Stage::kTransit;
  if (!has_own_first_leg_) {
    FlightLeg first;
    first.waypoint = 0;
    first.airspeed_mps = params_.legs.airspeed_mps;
    legs_.insert(legs_.begin(), first);  // within the capacity reserved by take_plan()
  }
  lay_transit(state);
  pilot_.start(legs_, 0, state, course_.course_rad, true);
}

/// During the turn the path to the plan starts at the vehicle.
void AirMission::lay_transit(const GuidanceState& state) {
  const Eigen::Vector3d here_W(state.position.x(), state.position.y(), height_.height_m());
  if ((goal_W_ - here_W).head<2>().norm() < 1.0) return;
  legs_.front().frame = LegFrame(here_W, goal_W_);
  pilot_.aim(legs_.front().frame);
}

}  // namespace vinerow::controllers
