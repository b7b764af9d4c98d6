#include "controllers/waypoint_guidance/air_mission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/aircraft/wind_triangle.h"

namespace vinerow::controllers {

using Phase = AirReference::Phase;

AirMission::AirMission(const WaypointGuidanceParams& params)
    : params_(params),
      generator_(params.legs.turn),
      pilot_(params.pilot),
      airspeed_mps_(params.legs.airspeed_mps),
      wanted_airspeed_mps_(params.legs.airspeed_mps) {}

void AirMission::take_plan(FlightLegs plan, const GuidanceState& start) {
  length_m_ = plan.length_m;
  legs_ = std::move(plan.legs);
  legs_.reserve(legs_.size() + 1);  // for the path to the plan
  final_.resize(1);
  start_ = start;
}

void AirMission::begin(const GuidanceState& state) {
  launch_ = state;
  has_power_ = true;
  const FlightLeg& first = legs_.front();
  const double away_m = (first.frame.from_W().head<2>() - state.position).norm();
  has_own_first_leg_ =
      first.kind == PathKind::kTransit && legs_.size() > 1 && away_m < params_.join_m;
  goal_W_ = has_own_first_leg_ ? first.frame.to_W() : first.frame.from_W();
  if (is_flying(state)) {
    join(state);
  } else {
    launch(state);
  }
}

bool AirMission::is_flying(const GuidanceState& state) const {
  constexpr double kAirShare = 0.7, kGroundShare = 0.3;  // of the cruise speed
  return state.airspeed_mps() > kAirShare * params_.cruise_mps &&
         state.velocity.norm() > kGroundShare * params_.cruise_mps;
}

void AirMission::advance(double dt_s, const GuidanceState& state) {
  event_text_.clear();
  Wanted wanted;
  switch (stage_) {
    case Stage::kWait:
      return;
    case Stage::kLaunch:
      wanted = fly_launch(state);
      break;
    case Stage::kClimb:
      wanted = fly_climb(state);
      break;
    case Stage::kTransit:
    case Stage::kLegs:
      wanted = fly_legs(dt_s, state);
      break;
    case Stage::kLoiter:
    case Stage::kInAir:
      wanted = fly_loiter(dt_s, state);
      break;
    case Stage::kDescend:
      wanted = fly_descend(state);
      break;
    case Stage::kLand:
      wanted = fly_land(dt_s, state);
      break;
    case Stage::kDone:
      has_power_ = false;
      return;
  }
  if (stage_ == Stage::kDone) {
    has_power_ = false;
    height_.start(height_.height_m());
    return;
  }
  course_ = wanted.course;
  const double max_mps = params_.airspeed_rate_mps2 * dt_s;
  airspeed_mps_ += std::clamp(wanted_airspeed_mps_ - airspeed_mps_, -max_mps, max_mps);
  watch_wind(dt_s, state);
  const double heading_rad =
      course_.course_rad + calc_crab(course_.course_rad, state.wind, airspeed_mps_).angle_rad;
  generator_.advance(dt_s, heading_rad, course_.rate_radps, airspeed_mps_);
  height_.advance(dt_s, wanted.height_m, wanted.rate_mps,
                  -airspeed_mps_ * std::sin(wanted.descent_max_rad),
                  airspeed_mps_ * std::sin(wanted.climb_max_rad));
}

AirMission::Wanted AirMission::hold() const {
  return {{course_.course_rad, 0.0},
          height_.height_m(),
          0.0,
          params_.legs.climb_max_rad,
          params_.legs.descent_max_rad};
}

AirMission::Wanted AirMission::fly_legs(double dt_s, const GuidanceState& state) {
  if (stage_ == Stage::kTransit && pilot_.is_turning()) lay_transit(state);
  const std::size_t before = pilot_.leg();
  Wanted wanted = hold();
  wanted.course = pilot_.advance(legs_, state, generator_, dt_s);
  if (pilot_.leg() != before) stage_ = Stage::kLegs;
  wanted_airspeed_mps_ = legs_[pilot_.leg()].airspeed_mps;
  const HeightPoint height =
      calc_height(legs_, pilot_.leg(), pilot_.ramp_along_m(), params_.kink_m);
  wanted.height_m = height.height_m;
  wanted.rate_mps = height.slope * pilot_.ramp_speed_mps();
  if (pilot_.has_ended()) end_plan(state);
  return wanted;
}

void AirMission::end_plan(const GuidanceState& state) {
  using End = WaypointGuidanceParams::End;
  circling_s_ = 0.0;
  circle_ = {legs_.back().frame.to_W().head<2>(), params_.loiter_radius_m, params_.loiter_side};
  switch (params_.end) {
    case End::kStop:
      stage_ = Stage::kInAir;
      report_event(
          false,
          fmt::format("ends its mission in the air at the last waypoint, after {:.0f} m, and "
                      "circles about it",
                      length_m_));
      return;
    case End::kLoiter:
      stage_ = Stage::kLoiter;
      report_event(false,
                   fmt::format("circles about the last waypoint for {:.0f} s", params_.loiter_s));
      return;
    case End::kLand:
      lay_landing(state);
  }
}

AirMission::Wanted AirMission::fly_loiter(double dt_s, const GuidanceState& state) {
  Wanted wanted = hold();
  wanted.course = circle_.course(state, params_.pilot.cross_track_length_m, course_.course_rad);
  wanted.height_m = legs_.back().frame.to_W().z();
  circling_s_ += dt_s;
  if (stage_ == Stage::kLoiter && circling_s_ >= params_.loiter_s) {
    stage_ = Stage::kInAir;
    report_event(
        false,
        fmt::format("ends its mission in the air after {:.0f} s of circles, and keeps circling",
                    circling_s_));
  }
  return wanted;
}

Phase AirMission::phase() const {
  switch (stage_) {
    case Stage::kWait:
      return Phase::kWait;
    case Stage::kLaunch:
      return is_launched_ ? Phase::kStraight : Phase::kLaunch;
    case Stage::kTransit:
    case Stage::kLegs:
      return pilot_.is_turning() ? Phase::kTurn : Phase::kStraight;
    case Stage::kClimb:
    case Stage::kLoiter:
    case Stage::kDescend:
      return Phase::kLoiter;
    case Stage::kLand:
      return Phase::kLand;
    case Stage::kInAir:
    case Stage::kDone:
      break;
  }
  return Phase::kDone;
}

double AirMission::cross_track_m(const GuidanceState& state) const {
  switch (stage_) {
    case Stage::kTransit:
    case Stage::kLegs:
      return legs_[pilot_.leg()].frame.left_m(state.position);
    case Stage::kLand:
      return final_.front().frame.left_m(state.position);
    case Stage::kClimb:
    case Stage::kLoiter:
    case Stage::kInAir:
    case Stage::kDescend:
      // The inside of a circle to the left is to its left.
      return circle_.side * (circle_.radius_m - circle_.away_m(state.position));
    default:
      return 0.0;
  }
}

int AirMission::waypoint() const {
  switch (stage_) {
    case Stage::kWait:
      return 0;
    case Stage::kLaunch:
    case Stage::kClimb:
      return has_own_first_leg_ ? legs_.front().waypoint : 0;
    case Stage::kTransit:
    case Stage::kLegs:
      return legs_[pilot_.leg()].waypoint;
    default:
      return legs_.back().waypoint;
  }
}

double AirMission::distance_m(const GuidanceState& state) const {
  if (stage_ == Stage::kWait || stage_ == Stage::kLaunch || stage_ == Stage::kClimb) return 0.0;
  if (stage_ != Stage::kTransit && stage_ != Stage::kLegs) return length_m_;
  const FlightLeg& leg = legs_[pilot_.leg()];
  const double share = leg.frame.along_m(state.position) / leg.frame.length_m();
  return leg.start_m + leg.plan_length_m * std::clamp(share, 0.0, 1.0);
}

void AirMission::watch_wind(double dt_s, const GuidanceState& state) {
  constexpr double kPatience_s = 2.0;
  const bool is_lying = stage_ == Stage::kLand && !has_power_;
  const bool is_possible =
      is_lying || calc_crab(course_.course_rad, state.wind, airspeed_mps_).is_possible;
  against_s_ = is_possible ? 0.0 : against_s_ + dt_s;
  if (has_reported_wind_ || against_s_ < kPatience_s) return;
  has_reported_wind_ = true;
  report_event(true,
               fmt::format("wind of {:.1f} m/s: no heading holds bearing {:.0f} deg at {:.1f} "
                           "m/s through the air, points as far into the wind as useful",
                           state.wind.norm(), bearing_deg(course_.course_rad), airspeed_mps_));
}

void AirMission::report_event(bool is_bad, std::string text) {
  event_text_ = std::move(text);
  is_warning_ = is_bad;
}

}  // namespace vinerow::controllers
