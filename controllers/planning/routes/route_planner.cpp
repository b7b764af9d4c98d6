#include "controllers/planning/routes/route_planner.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "controllers/parts/paths/lift.h"
#include "controllers/planning/routes/leg_detour.h"
#include "controllers/planning/routes/route_clearance.h"
#include "controllers/planning/routes/row_check.h"
#include "controllers/planning/search/analytic_turn.h"
#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kOnTheLine_m = 0.05;
constexpr double kAlongTheLine_rad = 0.1;

Eigen::Vector2d calc_size(const std::vector<Eigen::Vector2d>& outline) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : outline) box.extend(p);
  return box.sizes();
}

class RoutePlanner final : public Planner {
 public:
  RoutePlanner(const RoutePlannerParams& params, std::unique_ptr<PoseSearch> search,
               const PlannerContext& context, std::shared_ptr<const DistanceField> field)
      : params_(params),
        search_(std::move(search)),
        map_(*context.map),
        scene_(context.scene),
        field_(field ? std::move(field) : std::make_shared<const DistanceField>(map_.occupancy)),
        footprint_(*field_, context.vehicle_description->outline_B(), params.margin_m),
        clearance_(map_, footprint_, params.check_step_m) {}

  const PlanReport* report() const override { return &report_; }

  Result<PlannedPath> plan(const Pose& start) override {
    report_ = {};
    for (const char* name : {"nodes", "iterations", "turns"}) report_.numbers[name] = 0.0;
    Result<PlannedPath> path = plan_on_grid(start);
    if (path) path = lift(start.p.z(), path.value());
    lift_tree(start.p.z());
    return path;
  }

 private:
  Result<PlannedPath> plan_on_grid(const Pose& start) {
    const Pose2 pose = {start.p.head<2>(), yaw_from_quaternion(start.q)};
    auto legs = make_row_route(map_, params_.route, pose.p);
    if (!legs) return Failure{legs.reason()};
    std::vector<RouteLeg> route = *legs;
    if (!footprint_.is_free(pose))
      return Failure{"start in collision: " + clearance_.describe(pose)};
    for (const RouteLeg& leg : route) {
      if (const auto fault = clearance_.find_blocked_end(leg)) return Failure{*fault};
    }

    PathSegments pieces;
    if (const auto fault = append_approach(pose, route.front(), pieces)) return Failure{*fault};
    if (const auto fault = append_driven(route.front(), pieces)) return Failure{*fault};
    for (std::size_t i = 1; i < route.size(); ++i) {
      if (const auto fault = append_turn(route[i - 1], route[i], static_cast<int>(i), pieces)) {
        return Failure{*fault};
      }
      if (const auto fault = append_driven(route[i], pieces)) return Failure{*fault};
    }
    measure(pieces);
    PlannedPath path = make_planned_path(pieces, params_.pitch_m);
    if (const auto fault = find_path_into_row(path, map_, 0.0)) return Failure{*fault};
    return path;
  }

  /// Appends the path from the vehicle's pose to the first leg: a straight; or a short merge into
  /// the leg if the vehicle is slightly beside it; else the result of the search. A vehicle on the
  /// leg starts there.
  std::optional<std::string> append_approach(const Pose2& pose, RouteLeg& leg,
                                             PathSegments& pieces) {
    const Pose2 entry = leg.entry();
    const Eigen::Vector2d along = direction(entry.yaw_rad);
    const Eigen::Vector2d offset = entry.p - pose.p;
    const double ahead_m = offset.dot(along);
    const double first_m = (leg.line_W[1] - leg.line_W[0]).norm();
    const bool is_aligned =
        std::abs(wrap_angle(pose.yaw_rad - entry.yaw_rad)) < kAlongTheLine_rad &&
        std::abs(cross(along, offset)) < kOnTheLine_m;
    if (is_aligned && std::abs(ahead_m) <= kOnTheLine_m) return std::nullopt;
    if (is_aligned && ahead_m < 0.0 && -ahead_m < first_m - kOnTheLine_m) {
      leg.line_W.front() = advance(entry, -ahead_m, 0.0).p;
      return std::nullopt;
    }
    if (is_aligned && ahead_m > 0.0 &&
        std::abs(cross(along, offset)) < kAlongTheLine_rad * ahead_m) {
      const PathSegment straight =
          make_straight(pose.p, entry.p, PathKind::kTransit, -1, params_.speed_mps);
      if (clearance_.is_free({straight})) {
        pieces.push_back(straight);
        return std::nullopt;
      }
    }
    if (append_merge(pose, leg, first_m, pieces)) return std::nullopt;

    SearchReport done;
    const auto found = search_->find(pose, entry, footprint_, 0, done);
    add_search(done, report_);
    if (!found) {
      return fmt::format("no path from the start at {} to the entrance of alley {} at {}: {}",
                         to_string(pose), leg.alley, to_string(entry), found.reason());
    }
    append_labelled(*found, PathKind::kTransit, pieces);
    return std::nullopt;
  }

  /// Appends the leg with detours around obstacles in it.
  std::optional<std::string> append_driven(const RouteLeg& leg, PathSegments& pieces) {
    if (!clearance_.find_blocked(leg)) {
      append_leg(leg, params_.speed_mps, pieces);
      return std::nullopt;
    }
    // Random streams separate from those of the turns, which have the numbers of the legs.
    constexpr int kFirstProblem = 1'000'000, kProblemsPerLeg = 1000;
    std::vector<SearchReport> done;
    const auto detour = drive_around(
        leg, footprint_, clearance_, *search_, kFirstProblem + kProblemsPerLeg * leg.alley,
        {params_.turning_radius_m, params_.check_step_m, params_.speed_mps}, done);
    for (const SearchReport& search : done) add_search(search, report_);
    if (!detour) return detour.reason();
    ++report_.numbers["legs_with_detours"];
    pieces.insert(pieces.end(), detour->begin(), detour->end());
    return std::nullopt;
  }

  /// Appends a Dubins path onto the leg that is hardly longer than the straight line.
  bool append_merge(const Pose2& pose, RouteLeg& leg, double first_m, PathSegments& pieces) const {
    constexpr double kLongestMerge_m = 12.0, kStep_m = 0.5, kShareLonger = 0.05;
    const double longest_m = std::min(kLongestMerge_m, first_m - kStep_m);
    for (double s = 0.0; s <= longest_m; s += kStep_m) {
      const Pose2 joint = advance(leg.entry(), s, 0.0);
      const DubinsPath dubins = calc_dubins(pose, joint, params_.turning_radius_m);
      if (dubins.length_m() > (1.0 + kShareLonger) * (joint.p - pose.p).norm()) continue;
      PathSegments merge;
      append_dubins(pose, dubins, PathKind::kTransit, params_.turn_speed_mps, merge);
      if (!clearance_.is_free(merge)) continue;
      pieces.insert(pieces.end(), merge.begin(), merge.end());
      leg.line_W.front() = joint.p;
      return true;
    }
    return false;
  }

  std::optional<std::string> append_turn(const RouteLeg& from, const RouteLeg& to, int problem,
                                         PathSegments& pieces) {
    SearchReport done;
    const auto found = search_->find(from.exit(), to.entry(), footprint_, problem, done);
    add_search(done, report_);
    if (found) {
      append_labelled(*found, PathKind::kTurn, pieces);
      ++report_.numbers["turns"];
      if (done.first_length_m > 0.0) {
        report_.numbers["first_turn_length_m"] += done.first_length_m;
      }
      return std::nullopt;
    }
    const auto missing_m =
        calc_missing_clearance_m(from.exit(), to.entry(), params_.turning_radius_m, *field_,
                                 footprint_.outline_B(), params_.margin_m);
    constexpr double kFits_m = 0.005;
    if (missing_m && *missing_m < kFits_m) {
      return fmt::format("no turn from alley {} to alley {} found: {}", from.alley, to.alley,
                         found.reason());
    }
    if (!missing_m) {
      return fmt::format("no free ground connects alley {} at {} and alley {} at {}: {}",
                         from.alley, to_string(from.exit()), to.alley, to_string(to.entry()),
                         found.reason());
    }
    const Eigen::Vector2d size = calc_size(footprint_.outline_B());
    return fmt::format(
        "the turn from alley {} to alley {} needs {}{:.2f} m more clearance at the turning radius "
        "of "
        "{:.2f} m (footprint {:.1f} x {:.1f} m, margin {:.2f} m): {}",
        from.alley, to.alley, *missing_m < kClearanceReach_m ? "" : "at least ", *missing_m,
        params_.turning_radius_m, size.x(), size.y(), params_.margin_m, found.reason());
  }

  void append_labelled(const PathSegments& found, PathKind kind, PathSegments& pieces) const {
    for (PathSegment piece : found) {
      piece.kind = kind;
      piece.speed_mps = params_.turn_speed_mps;
      pieces.push_back(piece);
    }
  }

  void measure(const PathSegments& pieces) {
    double min_m = std::numeric_limits<double>::infinity(), min_in_turns_m = min_m;
    for (const PathSegment& piece : pieces) {
      const double piece_clearance_m = clearance_.clearance_m(piece);
      min_m = std::min(min_m, piece_clearance_m);
      if (piece.kind != PathKind::kTurn) continue;
      min_in_turns_m = std::min(min_in_turns_m, piece_clearance_m);
      report_.numbers["turn_length_m"] += piece.length_m;
    }
    report_.numbers["length_m"] = calc_length_m(pieces);
    report_.numbers["clearance_m"] = min_m;
    if (report_.numbers["turns"] > 0.0) report_.numbers["turn_clearance_m"] = min_in_turns_m;
  }

  Result<PlannedPath> lift(double height_m, PlannedPath path) const {
    if (const auto fault = lift_to_ground(scene_, height_m, path)) return Failure{*fault};
    return path;
  }

  void lift_tree(double height_m) {
    for (Eigen::Vector3d& p : report_.tree.points_W) {
      p.z() = height_m;
      if (scene_ == nullptr) continue;
      if (const auto ground = scene_->ground_height_m(p.x(), p.y(), kAboveEverything_m)) {
        p.z() = *ground;
      }
    }
  }

  RoutePlannerParams params_;
  std::unique_ptr<PoseSearch> search_;
  const RowMap& map_;
  const SceneQuery* scene_;
  std::shared_ptr<const DistanceField> field_;
  Footprint footprint_;
  RouteClearance clearance_;
  PlanReport report_;
};

}  // namespace

void add_search(const SearchReport& done, PlanReport& report) {
  report.numbers["nodes"] += static_cast<double>(done.nodes);
  report.numbers["iterations"] += static_cast<double>(done.iterations);
  for (const Eigen::Vector2d& p : done.tree_W) {
    report.tree.points_W.emplace_back(p.x(), p.y(), 0.0);
  }
}

const ParameterTable<RoutePlannerParams>& route_planner_table() {
  using P = RoutePlannerParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .include(&P::route, row_route_table())
          .number("beyond_m", "m", inside(&P::route, &RowRouteParams::beyond_m), between(0.0, 50.0),
                  "length of legs beyond the row ends before and after a turn")
          .number("turning_radius_m", "m", &P::wanted_radius_m, kPositive,
                  "minimum turning radius; default the vehicle's own")
          .number("margin_m", "m", &P::margin_m, between(0.0, 5.0),
                  "clearance of every planned pose around the vehicle's outline")
          .number("waypoint_pitch_m", "m", &P::pitch_m, kPositive,
                  "straights and arcs are split into round(length / pitch) parts")
          .number("speed_mps", "m/s", &P::speed_mps, between(0.0, 100.0),
                  "wanted speed on legs; 0 = the follower's own")
          .number("turn_speed_mps", "m/s", &P::turn_speed_mps, between(0.0, 100.0),
                  "wanted speed in turns; 0 = the follower's own");
  return table;
}

namespace {

double find_turning_radius_m(const std::optional<double>& wanted_m,
                             const VehicleDescription& vehicle, const std::string& who) {
  const std::optional<double>& own_m = vehicle.min_turning_radius_m;
  if (!wanted_m) {
    const double radius_m = vehicle.need(own_m, "min_turning_radius_m", who);
    if (radius_m > 0.0) return radius_m;
    throw ConfigError(fmt::format("{}: vehicle type '{}' turns on the spot: give turning_radius_m",
                                  who, vehicle.type));
  }
  if (own_m && *wanted_m < *own_m) {
    throw ConfigError(
        fmt::format("{}: turning_radius_m = {:.3f} m is less than the {:.3f} m that vehicle type "
                    "'{}' can turn",
                    who, *wanted_m, *own_m, vehicle.type));
  }
  return *wanted_m;
}

}  // namespace

RoutePlannerParams read_route_planner_params(const ParameterSet& parameters,
                                             const PlannerContext& context,
                                             const std::string& who) {
  RoutePlannerParams params = route_planner_table().read(parameters, who);
  complete_route_params(context, who, params);
  return params;
}

void complete_route_params(const PlannerContext& context, const std::string& who,
                           RoutePlannerParams& params) {
  const int alley_count = context.map == nullptr ? 0 : static_cast<int>(context.map->alleys.size());
  if (alley_count == 0) throw ConfigError(who + ": the map has no alleys to drive");
  params.route.demand_alleys(alley_count, who);
  params.turning_radius_m =
      find_turning_radius_m(params.wanted_radius_m, *context.vehicle_description, who);
}

std::unique_ptr<Planner> make_route_planner(const RoutePlannerParams& params,
                                            std::unique_ptr<PoseSearch> search,
                                            const PlannerContext& context,
                                            std::shared_ptr<const DistanceField> field) {
  if (context.map == nullptr || context.map->alleys.empty()) {
    throw ConfigError(context.part + ": the map has no alleys to drive");
  }
  if (context.map->occupancy.empty()) {
    throw ConfigError(context.part + ": the map has no occupancy grid: set occupancy_cell_m");
  }
  return std::make_unique<RoutePlanner>(params, std::move(search), context, std::move(field));
}

}  // namespace vinerow::controllers
