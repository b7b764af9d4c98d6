#include "controllers/waypoint_guidance/flight_legs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

struct Waypoint {
  Eigen::Vector3d p_W;
  double speed_mps;
  int index;
  PathKind kind;
  double distance_m;
};

double calc_turn_m(const FlightLeg& before, const FlightLeg& after, double radius_m) {
  const double corner_rad =
      std::abs(wrap_angle(after.frame.course_rad() - before.frame.course_rad()));
  return radius_m * std::tan(0.5 * std::min(corner_rad, kReversal_rad));
}

/// Warns of the leg that lacks most of the length of its two turns.
void warn_of_turns(const FlightLegsOptions& options, FlightLegs& result) {
  const auto& legs = result.legs;
  int count = 0;
  double worst_m = 0.0;
  std::string text;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const double radius_m = options.turn.radius_m(legs[i].airspeed_mps);
    double need_m = i > 0 ? calc_turn_m(legs[i - 1], legs[i], radius_m) : 0.0;
    if (i + 1 < legs.size()) need_m += calc_turn_m(legs[i], legs[i + 1], radius_m);
    const double length_m = legs[i].frame.length_m();
    if (need_m <= length_m) continue;
    ++count;
    if (need_m - length_m <= worst_m) continue;
    worst_m = need_m - length_m;
    text = fmt::format(
        "waypoint {} is {:.1f} m after its predecessor and the turns there take {:.1f} m "
        "(radius {:.1f} m at {:.1f} m/s and {:.0f} deg of bank)",
        legs[i].waypoint, length_m, need_m, radius_m, legs[i].airspeed_mps,
        deg_from_rad(options.turn.bank_rad));
  }
  if (count == 0) return;
  if (count > 1) {
    text += fmt::format(", and {} more {} too near", count - 1, count == 2 ? "is" : "are");
  }
  result.warnings.push_back(text + ": overshoots there");
}

void warn_of_slopes(const FlightLegsOptions& options, FlightLegs& result) {
  const FlightLeg* worst = nullptr;
  double worst_share = 1.0;
  for (const FlightLeg& leg : result.legs) {
    const double slope = leg.frame.slope();
    const double share = slope > 0.0 ? slope / std::tan(options.climb_max_rad)
                                     : -slope / std::tan(options.descent_max_rad);
    if (share <= worst_share) continue;
    worst = &leg;
    worst_share = share;
  }
  if (worst == nullptr) return;
  const bool climbs = worst->frame.slope() > 0.0;
  result.warnings.push_back(fmt::format(
      "the path to waypoint {} {} {:.1f} deg and the guidance {} {:.1f} deg: the height lags there",
      worst->waypoint, climbs ? "climbs" : "descends",
      deg_from_rad(std::atan(std::abs(worst->frame.slope()))),
      climbs ? "climbs at most" : "descends at most",
      deg_from_rad(climbs ? options.climb_max_rad : options.descent_max_rad)));
}

}  // namespace

Result<FlightLegs> make_flight_legs(const PlannedPath& plan, const FlightLegsOptions& options) {
  std::vector<Waypoint> waypoints;
  double distance_m = 0.0;
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const PathPoint& point = plan.points[i];
    if (!point.p_W.allFinite()) {
      return Failure{fmt::format("waypoint {} of the plan is not finite", i)};
    }
    const Waypoint waypoint{point.p_W, point.speed_mps, static_cast<int>(i), point.kind,
                            distance_m};
    if (waypoints.empty()) {
      waypoints.push_back(waypoint);
      continue;
    }
    const double step_m = (point.p_W - waypoints.back().p_W).head<2>().norm();
    if (step_m < kSameWaypoint_m) {
      waypoints.back() = waypoint;
    } else {
      distance_m += step_m;
      waypoints.push_back(waypoint);
      waypoints.back().distance_m = distance_m;
    }
  }
  if (waypoints.size() < 2) {
    return Failure{fmt::format("plan has {} waypoint{} apart from each other, needs two or more",
                               waypoints.size(), waypoints.size() == 1 ? "" : "s")};
  }
  FlightLegs result;
  result.length_m = distance_m;
  double clipped_mps = 0.0;
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    FlightLeg leg;
    leg.frame = LegFrame(waypoints[i].p_W, waypoints[i + 1].p_W);
    leg.kind = waypoints[i].kind;
    leg.waypoint = waypoints[i + 1].index;
    leg.start_m = waypoints[i].distance_m;
    leg.plan_length_m = leg.frame.length_m();
    const double wanted_mps = waypoints[i].speed_mps;
    leg.airspeed_mps = wanted_mps > 0.0 ? std::clamp(wanted_mps, options.min_airspeed_mps,
                                                     options.max_airspeed_mps)
                                        : options.airspeed_mps;
    if (wanted_mps > 0.0 && leg.airspeed_mps != wanted_mps) clipped_mps = wanted_mps;
    result.legs.push_back(leg);
  }
  if (clipped_mps > 0.0) {
    result.warnings.push_back(
        fmt::format("the plan wants {:.1f} m/s, which is not in the range {:.1f} to {:.1f} m/s "
                    "that can be flown with the turns' bank: flies the nearest",
                    clipped_mps, options.min_airspeed_mps, options.max_airspeed_mps));
  }
  warn_of_turns(options, result);
  warn_of_slopes(options, result);
  return result;
}

HeightPoint calc_height(const std::vector<FlightLeg>& legs, std::size_t leg, double along_m,
                        double kink_m) {
  while (along_m < 0.0 && leg > 0) along_m += legs[--leg].frame.length_m();
  while (along_m > legs[leg].frame.length_m() && leg + 1 < legs.size()) {
    along_m -= legs[leg++].frame.length_m();
  }
  const LegFrame& frame = legs[leg].frame;
  const double length_m = frame.length_m();
  const auto round = [&](const LegFrame& before, const LegFrame& after, double beyond_m,
                         double half_m) {
    const double change = after.slope() - before.slope();
    const double in_m = beyond_m + half_m;
    return HeightPoint{
        before.to_W().z() + before.slope() * beyond_m + change * in_m * in_m / (4.0 * half_m),
        before.slope() + change * in_m / (2.0 * half_m)};
  };
  if (leg > 0) {
    const LegFrame& before = legs[leg - 1].frame;
    const double half_m = std::min({kink_m, 0.5 * length_m, 0.5 * before.length_m()});
    if (along_m < half_m) return round(before, frame, along_m, half_m);
  }
  if (leg + 1 < legs.size()) {
    const LegFrame& after = legs[leg + 1].frame;
    const double half_m = std::min({kink_m, 0.5 * length_m, 0.5 * after.length_m()});
    if (along_m > length_m - half_m) return round(frame, after, along_m - length_m, half_m);
  }
  const bool is_inside = along_m >= 0.0 && along_m <= length_m;
  return {frame.height_m(along_m), is_inside ? frame.slope() : 0.0};
}

}  // namespace vinerow::controllers
