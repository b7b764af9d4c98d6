// Landing of AirMission: circles down beside the approach, glide, flare, rest on the ground.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/aircraft/wind_triangle.h"
#include "controllers/waypoint_guidance/air_mission.h"

namespace vinerow::controllers {

namespace {

/// Smallest clearance of the circle before the glide above the ground: several times the 0.6 m by
/// which the flying wing deviates from its height at most in the turbulence of the shipped
/// missions.
constexpr double kClear_m = 5.0;

/// Highest known ground below a circle; far below if none is known.
double find_highest_below(const GroundBelow& ground, const LoiterCircle& circle) {
  constexpr int kParts = 24;
  double highest_m = -1e9;
  for (int i = 0; i < kParts; ++i) {
    const double angle_rad = 2.0 * kPi * i / kParts;
    const Eigen::Vector2d to(std::cos(angle_rad), std::sin(angle_rad));
    const auto height_m = ground(circle.centre + circle.radius_m * to);
    if (height_m) highest_m = std::max(highest_m, *height_m);
  }
  return highest_m;
}

}  // namespace

AirMission::Approach AirMission::lay_approach(const Eigen::Vector2d& place,
                                              double course_rad) const {
  Approach approach;
  approach.course_rad = course_rad;
  const auto below = ground_ ? ground_(place) : std::nullopt;
  const double ground_m =
      params_.land_height_m.value_or(below.value_or(start_.height_m - params_.rest_height_m));
  const LandingSlope slope(ground_m + params_.belly_m, params_.glide_rad, params_.flare_m);
  // No climb for the landing, unless it is lower than the flare.
  const double above_m = std::clamp(height_.height_m() - slope.touchdown_m(),
                                    std::min(params_.approach_height_m, 4.0 * params_.flare_m),
                                    params_.approach_height_m);
  const Eigen::Vector2d along(std::cos(course_rad), std::sin(course_rad));
  const double length_m = slope.length_m(above_m);
  const Eigen::Vector2d entry = place - length_m * along;
  double from_m = slope.touchdown_m() + above_m;
  approach.path = LandingPath(slope);
  if (below) {
    // The given height counts, and the map's shape relative to it.
    const double lift_m = ground_m - *below + params_.belly_m;
    approach.path = LandingPath(slope, {place, along, length_m}, ground_, lift_m);
    from_m = std::max(from_m, approach.path.highest_m());
  }
  approach.circle =
      LoiterCircle::tangent(entry, course_rad, params_.loiter_radius_m, params_.loiter_side);
  if (below) {
    // The height above the ground that it can lose again on the glide.
    const double ground_below_m = find_highest_below(ground_, approach.circle) + ground_m - *below;
    const double max_m = from_m + 0.5 * length_m * std::tan(params_.glide_rad);
    from_m = std::clamp(ground_below_m + kClear_m, from_m, max_m);
    approach.clearance_m = from_m - ground_below_m;
  }
  approach.leg = final_.front();
  approach.leg.frame =
      LegFrame({entry.x(), entry.y(), from_m}, {place.x(), place.y(), slope.touchdown_m()});
  approach.leg.airspeed_mps = params_.approach_mps;
  if (!below) return approach;
  // Down a slope it floats and slides for long; up a steep slope it cannot flare.
  constexpr double kFall = 0.03, kRise = 0.10, kRounding_m = 1e-6;
  const double rise = approach.path.rise();
  approach.fault = std::max({0.0, -kFall - rise, rise - kRise}) +
                   std::max(0.0, kClear_m - approach.clearance_m - kRounding_m);
  return approach;
}

/// Against the wind, or on the course of the start. If the ground forbids that, the nearest course
/// that the ground allows, and with wind none with a tail wind.
AirMission::Approach AirMission::choose_approach(const GuidanceState& state,
                                                 const Eigen::Vector2d& place) const {
  // Below this wind its direction is not reliable.
  constexpr double kWind_mps = 1.0;
  if (params_.land_course_rad) return lay_approach(place, *params_.land_course_rad);
  const bool has_wind = state.wind.norm() > kWind_mps;
  const double wanted_rad =
      has_wind ? std::atan2(-state.wind.y(), -state.wind.x()) : start_.yaw_rad;
  constexpr double kStep_rad = 15.0 * kPi / 180.0;
  const int steps = has_wind ? 6 : 12;
  Approach best = lay_approach(place, wanted_rad);
  for (int i = 1; i <= steps && best.fault > 0.0; ++i) {
    for (const double side : {1.0, -1.0}) {
      Approach other = lay_approach(place, wrap_angle(wanted_rad + side * i * kStep_rad));
      if (other.fault < best.fault) best = std::move(other);
    }
  }
  return best;
}

void AirMission::lay_landing(const GuidanceState& state) {
  const Eigen::Vector2d place = params_.land_at_m.value_or(start_.position);
  Approach approach = choose_approach(state, place);
  final_.front() = approach.leg;
  landing_ = std::move(approach.path);
  steepest_fall_ = landing_.knows_ground() ? landing_.steepest_fall() : 0.0;
  circle_ = approach.circle;
  stage_ = Stage::kDescend;
  const LegFrame& frame = final_.front().frame;
  std::string text = fmt::format(
      "lands at ({:.1f}, {:.1f}) on bearing {:.0f} deg: circles down to {:.0f} m above it",
      place.x(), place.y(), bearing_deg(approach.course_rad),
      frame.from_W().z() - frame.to_W().z());
  // Without a map only the height of the ground at the start is known.
  constexpr double kSameGround_m = 20.0;
  const double away_m = (place - start_.position).norm();
  const bool is_guess =
      !landing_.knows_ground() && !params_.land_height_m && away_m > kSameGround_m;
  if (is_guess) {
    text += fmt::format(
        "; assumes the ground there to be at z = {:.1f} m as at the start, {:.0f} m away: "
        "land_height_m sets it",
        frame.to_W().z() - params_.belly_m, away_m);
  }
  const bool is_low = approach.clearance_m < kClear_m - 1e-6;
  if (is_low) {
    text += fmt::format(
        "; its circles come within {:.1f} m of the ground: change approach_height_m, "
        "land_bearing_deg or loiter_side",
        approach.clearance_m);
  }
  report_event(is_guess || is_low, std::move(text));
}

AirMission::Wanted AirMission::fly_descend(const GuidanceState& state) {
  Wanted wanted = hold();
  wanted.course = circle_.course(state, params_.pilot.cross_track_length_m, course_.course_rad);
  // On the way there the ground below is unknown.
  if (circle_.away_m(state.position) < 2.0 * circle_.radius_m) {
    wanted.height_m = final_.front().frame.from_W().z();
  }
  if (is_on_final(state)) {
    stage_ = Stage::kLand;
    wanted_airspeed_mps_ = params_.approach_mps;
    pilot_.start(final_, 0, state, generator_.heading_rad(), false);
    report_event(false, fmt::format("glides from {:.1f} m above the touchdown",
                                    state.height_m - final_.front().frame.to_W().z()));
  }
  return wanted;
}

/// At the height at which the glide starts, and on a circle whose tangent leads onto its line.
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
  const double to_go_m = frame.length_m() - frame.along_m(state.position);
  const double speed_mps = std::max(0.0, frame.along().dot(state.velocity));
  const HeightPoint height = landing_.at(to_go_m);
  const HeightPoint lying = landing_.lying(to_go_m);
  wanted.height_m = std::min(height.height_m, frame.from_W().z());
  wanted.rate_mps = height.slope * speed_mps;
  wanted.descent_max_rad = 2.0 * params_.glide_rad + std::atan(steepest_fall_);
  if (!has_power_) {
    // It slows down, and may stop in the wind: from here on the reference descends to the ground
    // below with time, not with distance.
    const double min_m = lying.height_m - kBelow_m;
    const double along_ground_mps = lying.slope * speed_mps;
    wanted.height_m = std::max(height_.height_m(), min_m);
    wanted.rate_mps = along_ground_mps - (wanted.height_m > min_m ? kSink_mps : 0.0);
  }
  // Only a vehicle on the ground is this slow, wherever that is.
  const bool is_stalled = state.airspeed_mps() < 0.5 * params_.stall_mps;
  const double above_m = state.height_m - lying.height_m;
  // Past the place a powered vehicle would float on in the flare for a long distance, half a metre
  // too high.
  const bool is_past = frame.along_m(state.position) > frame.length_m();
  if (above_m < params_.power_off_m || is_past || is_stalled) has_power_ = false;
  constexpr double kStationary_mps = 0.5, kStationary_s = 1.0;
  const bool stands =
      std::hypot(state.velocity.norm(), state.climb_mps) < kStationary_mps && !has_power_;
  stationary_s_ = stands ? stationary_s_ + dt_s : 0.0;
  if (stationary_s_ >= kStationary_s) {
    stage_ = Stage::kDone;
    const Eigen::Vector2d goal = frame.to_W().head<2>();
    report_event(false,
                 fmt::format("landed at ({:.1f}, {:.1f}), {:.1f} m from the planned touchdown and "
                             "{:.2f} m above it",
                             state.position.x(), state.position.y(), (state.position - goal).norm(),
                             above_m));
    const double off_m = (state.position - goal).norm();
    if (off_m > params_.land_tolerance_m) {
      failure_ = fmt::format(
          "landed at ({:.1f}, {:.1f}), {:.1f} m from the planned touchdown, at most {:g} m "
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

}  // namespace vinerow::controllers
