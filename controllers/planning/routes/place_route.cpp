#include "controllers/planning/routes/place_route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/parts/paths/lift.h"
#include "controllers/planning/routes/route_planner.h"
#include "controllers/planning/routes/row_check.h"
#include "controllers/planning/search/analytic_turn.h"
#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kCheckStep_m = 0.1;

double find_radius_m(const PlaceRouteParams& params, const VehicleDescription& vehicle,
                     const std::string& who) {
  constexpr double kOnTheSpot_m = 0.5;
  const double own_m = vehicle.min_turning_radius_m.value_or(0.0);
  if (!params.turning_radius_m) return own_m > 0.0 ? own_m : kOnTheSpot_m;
  if (*params.turning_radius_m >= own_m) return *params.turning_radius_m;
  throw ConfigError(
      fmt::format("{}: turning_radius_m = {:g} m is less than the {:.3f} m that vehicle type '{}' "
                  "can turn",
                  who, *params.turning_radius_m, own_m, vehicle.type));
}

RrtQuartileParams search_params(const PlaceRouteParams& params, double radius_m) {
  RrtQuartileParams search;
  search.tree.curvature_per_m = 1.0 / radius_m;
  search.max_iterations = params.max_iterations;
  return search;
}

const RowMap& demand_grid(const RowMap* map, const std::string& who) {
  if (map == nullptr || map->occupancy.empty()) {
    throw ConfigError(who + ": the map has no occupancy grid: set occupancy_cell_m");
  }
  return *map;
}

}  // namespace

const ParameterTable<PlaceRouteParams>& place_route_table() {
  using P = PlaceRouteParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number(
              "turning_radius_m", "m", &P::turning_radius_m, kPositive,
              "minimum turning radius; default the vehicle's own, 0.5 m if it turns on the spot")
          .number("margin_m", "m", &P::margin_m, between(0.0, 5.0),
                  "clearance of every planned pose around the vehicle's outline")
          .number("waypoint_pitch_m", "m", &P::pitch_m, between(0.01, 1e3),
                  "straights and arcs are split into round(length / pitch) parts")
          .number("speed_mps", "m/s", &P::speed_mps, between(0.0, 100.0),
                  "wanted speed; 0 = the follower's own")
          .integer("max_iterations", &P::max_iterations, between(1, kMaxQuartileIterations),
                   "maximum number of nodes expanded per path");
  return table;
}

PlaceRoute::PlaceRoute(const PlaceRouteParams& params, const VehicleDescription& vehicle,
                       const RowMap* map, const PartContext& context, const std::string& who)
    : params_(params),
      radius_m_(find_radius_m(params, vehicle, who)),
      search_(search_params(params, radius_m_), context),
      map_(demand_grid(map, who)),
      field_(map_.occupancy),
      footprint_(field_, vehicle.outline_B(), params.margin_m),
      clearance_(map_, footprint_, kCheckStep_m) {}

Result<PlannedPath> PlaceRoute::find(const Pose& start, const std::vector<Eigen::Vector2d>& places,
                                     std::optional<double> end_yaw_rad, const SceneQuery* ground) {
  report_ = {};
  const std::vector<Pose2> poses =
      find_poses({start.p.head<2>(), yaw_from_quaternion(start.q)}, places, end_yaw_rad);
  if (poses.size() < 2) return Failure{"the vehicle is at the place already"};
  PathSegments pieces;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const auto joined = join(poses[i], poses[i + 1], static_cast<int>(i));
    if (!joined) {
      return Failure{fmt::format("no path from {} to {}: {}", to_string(poses[i]),
                                 to_string(poses[i + 1]), joined.reason())};
    }
    pieces.insert(pieces.end(), joined->begin(), joined->end());
  }
  for (PathSegment& piece : pieces) {
    piece.kind = piece.curvature_per_m == 0.0 ? PathKind::kLeg : PathKind::kTurn;
    piece.speed_mps = params_.speed_mps;
  }
  measure(pieces);
  PlannedPath path = make_planned_path(pieces, params_.pitch_m);
  if (const auto fault = find_path_into_row(path, map_, 0.0)) return Failure{*fault};
  if (const auto fault = lift_to_ground(ground, start.p.z(), path)) return Failure{*fault};
  return path;
}

/// An intermediate place is passed along the line from the place before to the place behind it or,
/// if clearance is small, with the heading of the largest clearance.
std::vector<Pose2> PlaceRoute::find_poses(const Pose2& start,
                                          const std::vector<Eigen::Vector2d>& places,
                                          std::optional<double> end_yaw_rad) const {
  std::vector<Pose2> poses = {start};
  constexpr double kSame_m = 1e-3;
  for (const Eigen::Vector2d& place : places) {
    // The way to where one is has no direction.
    if ((place - poses.back().p).norm() > kSame_m) poses.push_back({place, 0.0});
  }
  // With a heading there is one nevertheless.
  if (poses.size() == 1 && end_yaw_rad) poses.push_back({places.back(), 0.0});
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Pose2& behind = poses[std::min(i + 1, poses.size() - 1)];
    const Eigen::Vector2d chord = behind.p - poses[i - 1].p;
    poses[i].yaw_rad = find_free_yaw(poses[i].p, std::atan2(chord.y(), chord.x()));
  }
  if (end_yaw_rad) poses.back().yaw_rad = *end_yaw_rad;
  return poses;
}

double PlaceRoute::find_free_yaw(const Eigen::Vector2d& p, double wanted_rad) const {
  constexpr int kSteps = 24;        // steps of 7.5 deg to either side
  constexpr double kRoomy_m = 0.3;  // clearance beyond the margin, for turning
  double best_rad = wanted_rad, max_m = footprint_.clearance_m({p, wanted_rad});
  if (max_m >= params_.margin_m + kRoomy_m) return wanted_rad;
  for (int i = 1; i <= kSteps; ++i) {
    const double aside_rad = kPi * i / kSteps;
    for (const double yaw_rad : {wanted_rad + aside_rad, wanted_rad - aside_rad}) {
      constexpr double kMore_m = 0.01;
      const double candidate_m = footprint_.clearance_m({p, yaw_rad});
      if (candidate_m < max_m + kMore_m) continue;
      best_rad = yaw_rad;
      max_m = candidate_m;
    }
  }
  return best_rad;
}

Result<PathSegments> PlaceRoute::join(const Pose2& from, const Pose2& to, int problem) {
  const std::vector<AnalyticTurn> words =
      make_analytic_turns(from, to, {.radius_m = radius_m_, .longest_lead_m = 0.0});
  for (const AnalyticTurn& word : words) {
    const PathSegments pieces = make_pieces(from, to, word);
    if (clearance_.is_free(pieces)) return pieces;
    break;  // only the shortest: a longer one may be a long detour
  }
  SearchReport done;
  auto found = search_.find(from, to, footprint_, problem, done);
  add_search(done, report_);
  return found;
}

void PlaceRoute::measure(const PathSegments& pieces) {
  double min_m = std::numeric_limits<double>::infinity();
  for (const PathSegment& piece : pieces) min_m = std::min(min_m, clearance_.clearance_m(piece));
  report_.numbers["length_m"] = calc_length_m(pieces);
  report_.numbers["clearance_m"] = min_m;
}

}  // namespace vinerow::controllers
