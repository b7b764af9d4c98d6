#include "controllers/waypoint_guidance/leg_pilot.h"

#include <algorithm>
#include <cmath>

#include "controllers/parts/aircraft/wind_triangle.h"

namespace vinerow::controllers {
namespace {

double calc_corner_rad(const std::vector<FlightLeg>& legs, std::size_t leg) {
  return wrap_angle(legs[leg + 1].frame.course_rad() - legs[leg].frame.course_rad());
}

double calc_heading_rad(double course_rad, const GuidanceState& state, double airspeed_mps) {
  return course_rad + calc_crab(course_rad, state.wind, airspeed_mps).angle_rad;
}

}  // namespace

double calc_fly_by_m(const TurnLimits& limits, double corner_rad, double ground_speed_mps,
                     double airspeed_mps) {
  const double radius_m =
      ground_speed_mps * ground_speed_mps / (airspeed_mps * limits.rate_radps(airspeed_mps));
  const double delay_s =
      0.5 * limits.bank_rad / limits.bank_rate_radps + limits.bank_lag_s + limits.yaw_lag_s;
  return radius_m * std::tan(0.5 * std::abs(corner_rad)) + ground_speed_mps * delay_s;
}

void LegPilot::start(const std::vector<FlightLeg>& legs, std::size_t leg,
                     const GuidanceState& state, double heading_rad, bool turns) {
  leg_ = leg;
  has_ended_ = false;
  is_turning_ = turns;
  turned_s_ = 0.0;
  course_rad_ = unwrap_near(legs[leg].frame.course_rad(), heading_rad);
  turn_from_m_ = turn_to_m_ = turn_angle_rad_ = ramp_speed_mps_ = 0.0;
  ramp_along_m_ = turns ? 0.0 : legs[leg].frame.along_m(state.position);
}

void LegPilot::aim(const LegFrame& frame) {
  course_rad_ = unwrap_near(frame.course_rad(), course_rad_);
}

WantedCourse LegPilot::advance(const std::vector<FlightLeg>& legs, const GuidanceState& state,
                               const HeadingGenerator& generator, double dt_s) {
  while (is_time_to_turn(legs, state, generator, dt_s)) take_next(legs, state, generator);
  const FlightLeg& leg = legs[leg_];
  if (is_turning_) watch_turn(leg, state, generator, dt_s);
  if (!is_turning_) {
    ramp_along_m_ = leg.frame.along_m(state.position);
    ramp_speed_mps_ = leg.frame.along().dot(state.velocity);
    has_ended_ = leg_ + 1 == legs.size() && ramp_along_m_ >= leg.frame.length_m();
  }
  return is_turning_ ? WantedCourse{course_rad_, 0.0} : query_law(leg.frame, state);
}

bool LegPilot::is_time_to_turn(const std::vector<FlightLeg>& legs, const GuidanceState& state,
                               const HeadingGenerator& generator, double dt_s) const {
  if (leg_ + 1 >= legs.size()) return false;
  const FlightLeg& leg = legs[leg_];
  const FlightLeg& next = legs[leg_ + 1];
  const double left_m = leg.frame.length_m() - leg.frame.along_m(state.position);
  if (left_m <= 0.0) return true;
  const double corner_rad = calc_corner_rad(legs, leg_);
  if (std::abs(corner_rad) < options_.turn_end_rad || std::abs(corner_rad) > kReversal_rad) {
    return false;
  }
  const double airspeed_mps = next.airspeed_mps;
  const TurnLimits& limits = generator.limits();
  if (!options_.is_predicted) {
    return left_m <= calc_fly_by_m(limits, corner_rad, state.velocity.norm(), airspeed_mps);
  }
  // Far from the corner no turn has to be simulated: none takes more than this to settle.
  constexpr double kSettle_s = 5.0;
  const double longest_s = std::abs(corner_rad) / limits.rate_radps(airspeed_mps) + kSettle_s;
  if (left_m > (airspeed_mps + state.wind.norm()) * longest_s) return false;
  const double wanted_rad = calc_heading_rad(course_rad_ + corner_rad, state, airspeed_mps);
  const PredictedTurn turn = predict_turn(generator, state.position, wanted_rad,
                                          options_.turn_end_rad, state.wind, airspeed_mps);
  const double short_m = std::copysign(1.0, corner_rad) * next.frame.left_m(turn.at_rest);
  // Half a tick early is as good as half a tick late.
  return short_m <= 0.5 * dt_s * state.velocity.norm() * std::abs(std::sin(corner_rad));
}

void LegPilot::take_next(const std::vector<FlightLeg>& legs, const GuidanceState& state,
                         const HeadingGenerator& generator) {
  const double corner_rad = calc_corner_rad(legs, leg_);
  turn_from_m_ = ramp_along_m_ - legs[leg_].frame.length_m();
  ++leg_;
  const FlightLeg& leg = legs[leg_];
  course_rad_ += corner_rad;
  double wanted_rad = calc_heading_rad(course_rad_, state, leg.airspeed_mps);
  PredictedTurn turn = predict_turn(generator, state.position, wanted_rad, options_.turn_end_rad,
                                    state.wind, leg.airspeed_mps);
  // Turns go from leg to leg. If the remainder is more than half a circle, because legs were too
  // short, the other direction may be better.
  const double round_rad = std::copysign(2.0 * kPi, generator.heading_rad() - wanted_rad);
  if (std::abs(wanted_rad - generator.heading_rad()) > kPi) {
    const PredictedTurn other = predict_turn(generator, state.position, wanted_rad + round_rad,
                                             options_.turn_end_rad, state.wind, leg.airspeed_mps);
    const double radius_m = generator.limits().radius_m(leg.airspeed_mps);
    const auto cost_m = [&](const PredictedTurn& predicted, double heading_rad) {
      constexpr double kTurningShare = 0.3;
      return std::abs(leg.frame.left_m(predicted.at_rest)) +
             kTurningShare * radius_m * std::abs(heading_rad - generator.heading_rad());
    };
    if (cost_m(other, wanted_rad + round_rad) < cost_m(turn, wanted_rad)) {
      turn = other;
      course_rad_ += round_rad;
      wanted_rad += round_rad;
    }
  }
  turn_angle_rad_ = std::abs(wanted_rad - generator.heading_rad());
  is_turning_ = turn_angle_rad_ > options_.turn_end_rad &&
                std::abs(wrap_angle(course_rad_ - state.course_rad())) > options_.turn_end_rad;
  turned_s_ = 0.0;
  turn_to_m_ = leg.frame.along_m(turn.near_end);
}

void LegPilot::watch_turn(const FlightLeg& leg, const GuidanceState& state,
                          const HeadingGenerator& generator, double dt_s) {
  const double wanted_rad = calc_heading_rad(course_rad_, state, leg.airspeed_mps);
  const double left_rad = std::abs(wanted_rad - generator.heading_rad());
  const double angle_travelled_rad = turn_angle_rad_ - options_.turn_end_rad;
  if (angle_travelled_rad > 0.0) {
    const double share = std::clamp((turn_angle_rad_ - left_rad) / angle_travelled_rad, 0.0, 1.0);
    ramp_along_m_ = turn_from_m_ + share * (turn_to_m_ - turn_from_m_);
    ramp_speed_mps_ = share < 1.0 ? (turn_to_m_ - turn_from_m_) / angle_travelled_rad *
                                        std::abs(generator.rate_radps())
                                  : 0.0;
  }
  // If an unknown wind keeps the vehicle off its course, the reference's own turn counts.
  constexpr double kPatience_s = 2.0;
  turned_s_ = left_rad < 0.5 * options_.turn_end_rad ? turned_s_ + dt_s : 0.0;
  const bool is_on_course =
      std::abs(wrap_angle(course_rad_ - state.course_rad())) < options_.turn_end_rad;
  if (is_on_course || turned_s_ > kPatience_s) is_turning_ = false;
}

WantedCourse LegPilot::query_law(const LegFrame& frame, const GuidanceState& state) const {
  const double left_m = frame.left_m(state.position);
  if (options_.is_smooth) {
    const double share = left_m / options_.cross_track_length_m;
    const double share_rate_per_s =
        frame.left().dot(state.velocity) / options_.cross_track_length_m;
    return {course_rad_ - std::atan(share), -share_rate_per_s / (1.0 + share * share)};
  }
  const double share = std::clamp(frame.along_m(state.position) / frame.length_m(), 0.0, 1.0);
  if (std::abs(left_m) <=
      calc_cross_track_tolerance_m(share, options_.tolerance_max_m, options_.tolerance_min_m)) {
    return {course_rad_, 0.0};
  }
  const Eigen::Vector2d offset = frame.to_W().head<2>() - state.position;
  return {course_rad_ + wrap_angle(std::atan2(offset.y(), offset.x()) - frame.course_rad()), 0.0};
}

}  // namespace vinerow::controllers
