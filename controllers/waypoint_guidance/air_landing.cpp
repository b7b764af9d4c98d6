// The landing of AirMission: circles down beside the approach, glides along it, flares, lies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/wind_triangle.h"
#include "controllers/waypoint_guidance/air_mission.h"

namespace vinerow {

void AirMission::lay_landing(const GuidanceState& state) {
  // With less wind than this its direction says little.
  constexpr double kWind_mps = 1.0;
  const double against_rad = std::atan2(-state.wind.y(), -state.wind.x());
  const double course_rad = params_.land_course_rad.value_or(
      state.wind.norm() > kWind_mps ? against_rad : start_.yaw_rad);
  const Eigen::Vector2d place = params_.land_at_m.value_or(start_.position);
  const double ground_m = params_.land_height_m.value_or(start_.height_m - params_.standing_m);
  slope_ = LandingSlope(ground_m + params_.belly_m, params_.glide_rad, params_.flare_m);
  // Never up again for the landing, unless it is lower than the flare.
  const double above_m = std::clamp(height_.height_m() - slope_.touchdown_m(),
                                    std::min(params_.approach_height_m, 4.0 * params_.flare_m),
                                    params_.approach_height_m);
  const Eigen::Vector2d along(std::cos(course_rad), std::sin(course_rad));
  const Eigen::Vector2d entry = place - slope_.length_m(above_m) * along;
  FlightLeg& leg = final_.front();
  leg.frame = LegFrame({entry.x(), entry.y(), slope_.touchdown_m() + above_m},
                       {place.x(), place.y(), slope_.touchdown_m()});
  leg.airspeed_mps = params_.approach_mps;
  circle_ = LoiterCircle::tangent(entry, course_rad, params_.loiter_radius_m, params_.loiter_side);
  stage_ = Stage::kDescend;
  std::string news = fmt::format(
      "lands at ({:.1f}, {:.1f}) on bearing {:.0f} deg: circles down to {:.0f} m above it",
      place.x(), place.y(), bearing_deg(course_rad), above_m);
  // It knows the ground at its start only.
  constexpr double kSameGround_m = 20.0;
  const double away_m = (place - start_.position).norm();
  const bool is_guess = !params_.land_height_m && away_m > kSameGround_m;
  if (is_guess) {
    news += fmt::format(
        "; takes the ground there to be at z = {:.1f} m as at the start, {:.0f} m away: "
        "land_height_m tells it",
        ground_m, away_m);
  }
  tell(is_guess, std::move(news));
}

AirMission::Wanted AirMission::fly_descend(const GuidanceState& state) {
  Wanted wanted = hold();
  wanted.course = circle_.course(state, params_.pilot.cross_track_length_m, course_.course_rad);
  // On the way there what is below is not known.
  if (circle_.away_m(state.position) < 2.0 * circle_.radius_m) {
    wanted.height_m = final_.front().frame.from_W().z();
  }
  if (is_on_final(state)) {
    stage_ = Stage::kLand;
    wanted_airspeed_mps_ = params_.approach_mps;
    pilot_.start(final_, 0, state, generator_.heading_rad(), false);
    tell(false, fmt::format("glides from {:.1f} m above the touchdown",
                            state.height_m - slope_.touchdown_m()));
  }
  return wanted;
}

/// At the height where the glide begins, and leaving the circle now leads onto its line.
bool AirMission::is_on_final(const GuidanceState& state) const {
  constexpr double kClose_m = 1.0, kQuarter_rad = 0.5 * kPi;
  const LegFrame& frame = final_.front().frame;
  if (std::abs(height_.height_m() - frame.from_W().z()) > kClose_m) return false;
  if (std::abs(circle_.away_m(state.position) - circle_.radius_m) > 0.5 * circle_.radius_m) {
    return false;
  }
  const double turn_rad = wrap_angle(frame.course_rad() - state.course_rad());
  if (circle_.side * turn_rad < 0.0 || std::abs(turn_rad) > kQuarter_rad) return false;
  const double course_rad = unwrap_near(frame.course_rad(), course_.course_rad);
  const double heading_rad =
      course_rad + calc_crab(course_rad, state.wind, airspeed_mps_).angle_rad;
  const PredictedTurn turn = predict_turn(generator_, state.position, heading_rad,
                                          params_.pilot.turn_end_rad, state.wind, airspeed_mps_);
  constexpr double kNearly_rad = 5.0 * kPi / 180.0;
  return circle_.side * frame.left_m(turn.at_rest) <= 0.0 || std::abs(turn_rad) < kNearly_rad;
}

AirMission::Wanted AirMission::fly_land(double dt_s, const GuidanceState& state) {
  constexpr double kSink_mps = 0.4, kBelow_m = 0.3;
  Wanted wanted = hold();
  wanted.course = pilot_.advance(final_, state, generator_, dt_s);
  const LegFrame& frame = final_.front().frame;
  const HeightPoint height = slope_.at(frame.length_m() - frame.along_m(state.position));
  wanted.height_m = std::min(height.height_m, frame.from_W().z());
  wanted.rate_mps = height.slope * std::max(0.0, frame.along().dot(state.velocity));
  wanted.descent_max_rad = 2.0 * params_.glide_rad;
  if (!has_power_) {
    // It slows down, and may stop in the wind: from here on down with the time, not the way.
    wanted.height_m = std::max(height_.height_m(), slope_.touchdown_m() - kBelow_m);
    wanted.rate_mps = wanted.height_m > slope_.touchdown_m() - kBelow_m ? -kSink_mps : 0.0;
  }
  // So slow only what lies on the ground is, wherever that is.
  const bool is_stalled = state.airspeed_mps() < 0.5 * params_.stall_mps;
  const double above_m = state.height_m - slope_.touchdown_m();
  // Past the place with power it would float on in the flare, half a metre too high, for a long way.
  const bool is_past = frame.along_m(state.position) > frame.length_m();
  if (above_m < params_.power_off_m || is_past || is_stalled) has_power_ = false;
  constexpr double kStanding_mps = 0.5, kStanding_s = 1.0;
  const bool stands =
      std::hypot(state.velocity.norm(), state.climb_mps) < kStanding_mps && !has_power_;
  standing_s_ = stands ? standing_s_ + dt_s : 0.0;
  if (standing_s_ >= kStanding_s) {
    stage_ = Stage::kDone;
    const Eigen::Vector2d goal = frame.to_W().head<2>();
    tell(false, fmt::format("landed at ({:.1f}, {:.1f}), {:.1f} m from where it should and {:.2f} "
                            "m above it",
                            state.position.x(), state.position.y(), (state.position - goal).norm(),
                            above_m));
    const double off_m = (state.position - goal).norm();
    if (off_m > params_.land_tolerance_m) {
      failure_ = fmt::format(
          "landed at ({:.1f}, {:.1f}), {:.1f} m from where it should, at most {:g} m "
          "(land_tolerance_m)",
          state.position.x(), state.position.y(), off_m, params_.land_tolerance_m);
    }
  }
  return wanted;
}

std::optional<Eigen::Vector2d> AirMission::touchdown() const {
  const bool lands = stage_ == Stage::kDescend || stage_ == Stage::kLand || stage_ == Stage::kDone;
  if (!lands) return std::nullopt;
  return Eigen::Vector2d(final_.front().frame.to_W().head<2>());
}

}  // namespace vinerow
