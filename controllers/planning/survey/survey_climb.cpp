#include "controllers/planning/survey/survey_climb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/parts/paths/pose2.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;

Result<SurveyClimb> try_climb(const SurveyRequest& request, double start_m, SurveyRoute route,
                              const GroundHeight& ground) {
  std::vector<Vector2d> line;
  for (const RoutePoint& point : route.points) line.push_back(point.p_W);
  auto profile = GroundProfile::make(line, ground);
  if (!profile) return Failure{profile.reason()};
  SurveyClimb climb;
  climb.wanted_m = make_wanted_heights(*profile, request.height_m, request.max_slope);
  if (!request.rotorcraft) {
    climb.length_m = start_heights_at(*profile, start_m, request.max_slope, climb.wanted_m);
  }
  climb.clearance_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < profile->samples().size(); ++i) {
    const GroundProfile::Sample& sample = profile->samples()[i];
    if (sample.distance_m > climb.length_m && i > 1) break;
    const double clearance_m = climb.wanted_m[i] - sample.ground_m;
    if (clearance_m >= climb.clearance_m) continue;
    climb.clearance_m = clearance_m;
    climb.where_m = sample.distance_m;
    climb.meets_W = sample.p_W;
  }
  climb.route = std::move(route);
  climb.profile = std::move(profile).value();
  return climb;
}

/// Distance of a corner along the path.
double distance_to(const SurveyClimb& climb, std::size_t point) {
  return climb.profile.samples()[climb.profile.at_point(point)].distance_m;
}

/// Whether the lane's height is reached before its pictures start.
bool is_high_enough(const SurveyClimb& climb) {
  return climb.length_m <= distance_to(climb, climb.route.first_lane_point);
}

SurveyRoute add_laps(const SurveyRequest& request, const Pose& start_W, const SurveyRoute& route,
                     double min_length_m, bool to_left) {
  const double radius_m = calc_turn_radius_m(request), yaw_rad = yaw_from_quaternion(start_W.q);
  const std::size_t first = route.first_lane_point;
  const Vector2d to_W = route.points[first].p_W, start = start_W.p.head<2>();
  std::vector<Vector2d> corners =
      make_climb_laps(start, yaw_rad, to_W, min_length_m, radius_m, to_left);
  // The path leaves the last lap at its last corner, heading back.
  const Vector2d along_W = (route.points[first + 1].p_W - to_W).normalized();
  const std::vector<Vector2d> approach =
      find_approach(corners.back(), Vector2d(-direction(yaw_rad)), to_W, along_W, radius_m);
  corners.insert(corners.end(), approach.begin(), approach.end());
  SurveyRoute longer = route;
  auto& points = longer.points;
  points.erase(points.begin() + 1, points.begin() + static_cast<std::ptrdiff_t>(first));
  std::vector<RoutePoint> laps;
  for (const Vector2d& p : corners) laps.push_back({p, PathKind::kTransit, -1});
  points.insert(points.begin() + 1, laps.begin(), laps.end());
  longer.first_lane_point = 1 + laps.size();
  return longer;
}

}  // namespace

Result<SurveyClimb> climb_to_first_lane(const SurveyRequest& request, const Pose& start_W,
                                        const SurveyRoute& route, const GroundHeight& ground) {
  const double start_m = start_W.p.z();
  auto straight = try_climb(request, start_m, route, ground);
  if (!straight) return straight;
  SurveyClimb best = std::move(straight).value();
  if (!is_high_enough(best)) {
    const std::vector<double> heights_m =
        make_wanted_heights(best.profile, request.height_m, request.max_slope);
    const double there_m = heights_m[best.profile.at_point(route.first_lane_point)];
    // A little more than needed, because of the terrain on the path to the first lane.
    constexpr double kMore = 1.01, kMore_m = 5.0;
    const double min_length_m = kMore * std::abs(there_m - start_m) / request.max_slope + kMore_m;
    best.clearance_m = -std::numeric_limits<double>::infinity();
    for (const bool to_left : {true, false}) {
      auto climb = try_climb(request, start_m,
                             add_laps(request, start_W, route, min_length_m, to_left), ground);
      if (!climb) return climb;
      if (climb->clearance_m > best.clearance_m) best = std::move(climb).value();
    }
  }
  constexpr double kLaunched_m = 30.0;  // nearer to the start the launch has its own path
  if (best.clearance_m <= 0.0 && best.where_m > kLaunched_m) {
    return Failure{fmt::format(
        "the climb from ({:.1f}, {:.1f}) at {:.0f} % meets the ground at ({:.1f}, {:.1f}), {:.0f} "
        "m "
        "along: start with another heading, from higher ground or with a larger max_slope",
        start_W.p.x(), start_W.p.y(), 100.0 * request.max_slope, best.meets_W.x(), best.meets_W.y(),
        best.where_m)};
  }
  if (!is_high_enough(best)) {
    return Failure{
        fmt::format("the flight cannot get from {:.1f} m to {:.1f} m above the ground of the first "
                    "lane at {:.0f} "
                    "%",
                    start_m, request.height_m, 100.0 * request.max_slope)};
  }
  return best;
}

/// Sentence such as "point 3 of the polygon at (x, y) is outside the terrain, ..."
std::optional<std::string> find_corner_outside(const Polygon& polygon, const GroundHeight& ground) {
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& p : polygon) middle += p / static_cast<double>(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    if (ground(p)) continue;
    const std::string point =
        fmt::format("point {} of the polygon at ({:.1f}, {:.1f})", i + 1, p.x(), p.y());
    // Find the start of the terrain on the line to the polygon's centre.
    constexpr int kSteps = 2000;
    const Vector2d to_centre = middle - p;
    for (int k = 1; k <= kSteps; ++k) {
      const double share = static_cast<double>(k) / kSteps;
      if (!ground(p + share * to_centre)) continue;
      return fmt::format(
          "{} is outside the terrain, which starts {:.1f} m from there towards the polygon's "
          "centre",
          point, share * to_centre.norm());
    }
    return fmt::format(
        "{} is outside the terrain, and so is the line to the polygon's centre at ({:.1f}, {:.1f})",
        point, middle.x(), middle.y());
  }
  return std::nullopt;
}

}  // namespace vinerow::controllers
