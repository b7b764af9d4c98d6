#include "controllers/planning/routes/go_to.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/distance_field.h"
#include "controllers/parts/paths/footprint.h"
#include "controllers/parts/paths/lift.h"
#include "controllers/planning/routes/route_clearance.h"
#include "controllers/planning/routes/route_planner.h"
#include "controllers/planning/routes/row_check.h"
#include "controllers/planning/search/analytic_turn.h"
#include "controllers/planning/search/rrt_quartile.h"
#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

struct GoToParams {
  std::vector<double> x_m, y_m;
  std::optional<double> bearing_rad;
  std::optional<double> turning_radius_m;
  double margin_m = 0.05;
  double pitch_m = 0.33;
  double speed_mps = 0.0;
  std::int64_t max_iterations = 1'000'000;
};

const ParameterTable<GoToParams>& go_to_table() {
  using P = GoToParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .numbers("x_m", "m", &P::x_m, kAnyNumber, "x of the places in W (east), in their order")
          .numbers("y_m", "m", &P::y_m, kAnyNumber, "y of the places in W (north), as many as x_m")
          .degrees(
              "end_bearing_deg", &P::bearing_rad, between(-360.0, 360.0),
              "heading at the last place, clockwise from north; default: the direction of arrival")
          .number(
              "turning_radius_m", "m", &P::turning_radius_m, kPositive,
              "minimum turning radius; default the vehicle's own, 0.5 m if it turns on the spot")
          .number("margin_m", "m", &P::margin_m, between(0.0, 5.0),
                  "clearance of every planned pose around the vehicle's outline")
          .number("waypoint_pitch_m", "m", &P::pitch_m, kPositive,
                  "straights and arcs are split into round(length / pitch) parts")
          .number("speed_mps", "m/s", &P::speed_mps, between(0.0, 100.0),
                  "wanted speed; 0 = the follower's own")
          .integer("max_iterations", &P::max_iterations, between(1, kMaxQuartileIterations),
                   "maximum number of nodes expanded per path")
          .rule([](const P& p) -> std::string {
            if (p.x_m.size() != p.y_m.size()) {
              return fmt::format("x_m has {} numbers and y_m {}, must be as many", p.x_m.size(),
                                 p.y_m.size());
            }
            return p.x_m.empty() ? "needs at least one place, x_m and y_m" : "";
          });
  return table;
}

double find_radius_m(const GoToParams& params, const VehicleDescription& vehicle,
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

RrtQuartileParams search_params(const GoToParams& params, double radius_m) {
  RrtQuartileParams search;
  search.tree.curvature_per_m = 1.0 / radius_m;
  search.max_iterations = params.max_iterations;
  return search;
}

class GoTo final : public Planner {
 public:
  GoTo(const GoToParams& params, const PlannerContext& context, const std::string& who)
      : params_(params),
        radius_m_(find_radius_m(params, *context.vehicle_description, who)),
        search_(search_params(params, radius_m_), context),
        map_(*context.map),
        scene_(context.scene),
        field_(map_.occupancy),
        footprint_(field_, context.vehicle_description->outline_B(), params.margin_m),
        clearance_(map_, footprint_, kCheckStep_m) {}

  const PlanReport* report() const override { return &report_; }

  Result<PlannedPath> plan(const Pose& start) override {
    report_ = {};
    const std::vector<Pose2> places =
        find_places({start.p.head<2>(), yaw_from_quaternion(start.q)});
    PathSegments pieces;
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      const auto joined = join(places[i], places[i + 1], static_cast<int>(i));
      if (!joined) {
        return Failure{fmt::format("no path from {} to {}: {}", to_string(places[i]),
                                   to_string(places[i + 1]), joined.reason())};
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
    if (const auto fault = lift_to_ground(scene_, start.p.z(), path)) return Failure{*fault};
    return path;
  }

 private:
  static constexpr double kCheckStep_m = 0.1;

  /// Places with headings: an intermediate place is passed along the line from the place before to
  /// the place behind it or, if clearance is small, with the heading of the largest clearance.
  std::vector<Pose2> find_places(const Pose2& start) const {
    std::vector<Pose2> places = {start};
    for (std::size_t i = 0; i < params_.x_m.size(); ++i) {
      places.push_back({{params_.x_m[i], params_.y_m[i]}, 0.0});
    }
    for (std::size_t i = 1; i < places.size(); ++i) {
      const Pose2& behind = places[std::min(i + 1, places.size() - 1)];
      const Eigen::Vector2d chord = behind.p - places[i - 1].p;
      places[i].yaw_rad = find_free_yaw(places[i].p, std::atan2(chord.y(), chord.x()));
    }
    if (params_.bearing_rad) places.back().yaw_rad = 0.5 * kPi - *params_.bearing_rad;
    return places;
  }

  double find_free_yaw(const Eigen::Vector2d& p, double wanted_rad) const {
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

  Result<PathSegments> join(const Pose2& from, const Pose2& to, int problem) {
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

  void measure(const PathSegments& pieces) {
    double min_m = std::numeric_limits<double>::infinity();
    for (const PathSegment& piece : pieces) min_m = std::min(min_m, clearance_.clearance_m(piece));
    report_.numbers["length_m"] = calc_length_m(pieces);
    report_.numbers["clearance_m"] = min_m;
  }

  GoToParams params_;
  double radius_m_;
  RrtQuartile search_;
  const RowMap& map_;
  const SceneQuery* scene_;
  DistanceField field_;
  Footprint footprint_;
  RouteClearance clearance_;
  PlanReport report_;
};

}  // namespace

PartSpec go_to_spec() {
  PartSpec spec;
  spec.name = "go_to";
  spec.description =
      "Path from the vehicle's position to given places, around rows and mapped obstacles: the "
      "shortest Dubins path if it is free, else the shortened result of the quartile tree of "
      "rrt_quartile on the occupancy grid.";
  spec.parameters = go_to_table().specs();
  spec.reads = {"estimate"};
  spec.writes = {"plan", "plan_tree"};
  return spec;
}

std::unique_ptr<Planner> make_go_to(const ParameterSet& parameters, const PlannerContext& context) {
  const std::string who = context.part + " (go_to)";
  const GoToParams params = go_to_table().read(parameters, who);
  if (context.map == nullptr || context.map->occupancy.empty()) {
    throw ConfigError(who + ": the map has no occupancy grid: set occupancy_cell_m");
  }
  return std::make_unique<GoTo>(params, context, who);
}

}  // namespace vinerow::controllers
