#include "controllers/planning/route_planner.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "controllers/planning/analytic_turn.h"
#include "controllers/planning/lift.h"
#include "controllers/planning/row_check.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

using Pieces = std::vector<PathPiece>;

constexpr double kOnTheLine_m = 0.05;
constexpr double kAlongTheLine_rad = 0.1;

Eigen::Vector2d calc_size(const std::vector<Eigen::Vector2d>& outline) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : outline) box.extend(p);
  return box.sizes();
}

std::string describe(const Pose2& pose) {
  return fmt::format("({:.2f}, {:.2f}) heading {:.1f} deg", pose.p.x(), pose.p.y(),
                     deg_from_rad(wrap_angle(pose.yaw_rad)));
}

/// The row whose canopy covers a point, or nullptr.
const PlantRow* find_row_at(const RowMap& map, const Eigen::Vector2d& p, double& distance_m) {
  for (const PlantRow& row : map.rows) {
    for (std::size_t i = 0; i + 1 < row.line_W.size(); ++i) {
      const Eigen::Vector2d a = row.line_W[i].head<2>(), ab = row.line_W[i + 1].head<2>() - a;
      const double share = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
      distance_m = (p - a - share * ab).norm();
      if (distance_m < 0.5 * row.canopy_width_m) return &row;
    }
  }
  return nullptr;
}

class RoutePlanner final : public Planner {
 public:
  RoutePlanner(const RoutePlannerParams& params, std::unique_ptr<PoseSearch> search,
               const PlannerContext& context)
      : params_(params),
        search_(std::move(search)),
        map_(*context.map),
        scene_(context.scene),
        field_(map_.occupancy),
        footprint_(field_, context.vehicle_description->outline_B(), params.margin_m) {}

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
    if (!footprint_.is_free(pose)) return Failure{"start in collision: " + tell_room(pose)};
    for (const RouteLeg& leg : route) {
      if (const auto fault = find_blocked(leg)) return Failure{*fault};
    }

    Pieces pieces;
    if (const auto fault = append_approach(pose, route.front(), pieces)) return Failure{*fault};
    append_leg(route.front(), params_.speed_mps, pieces);
    for (std::size_t i = 1; i < route.size(); ++i) {
      if (const auto fault = append_turn(route[i - 1], route[i], static_cast<int>(i), pieces)) {
        return Failure{*fault};
      }
      append_leg(route[i], params_.speed_mps, pieces);
    }
    count(pieces);
    PlannedPath path = make_planned_path(pieces, params_.pitch_m);
    if (const auto fault = find_path_into_row(path, map_, 0.0)) return Failure{*fault};
    return path;
  }

  std::string tell_room(const Pose2& pose) const {
    if (!field_.covers(pose.p)) {
      return fmt::format("{} lies outside the map's occupancy grid", describe(pose));
    }
    double distance_m = 0.0;
    if (const PlantRow* row = find_row_at(map_, pose.p, distance_m)) {
      return fmt::format(
          "{} lies in a row: {:.2f} m from the centre line of row {}, whose canopy is {:.2f} m "
          "wide",
          describe(pose), distance_m, row->id, row->canopy_width_m);
    }
    return fmt::format("at {} the footprint has {:.3f} m of room, the margin is {:.3f} m",
                       describe(pose), footprint_.clearance_m(pose), params_.margin_m);
  }

  std::optional<std::string> find_blocked(const RouteLeg& leg) const {
    for (const auto& [end, name] : {std::pair(leg.entry(), "entrance"), {leg.exit(), "exit"}}) {
      if (footprint_.is_free(end)) continue;
      return fmt::format("{} of alley {} blocked: {}", name, leg.alley, tell_room(end));
    }
    Pieces pieces;
    append_leg(leg, 0.0, pieces);
    for (const PathPiece& piece : pieces) {
      const int parts = static_cast<int>(std::ceil(piece.length_m / params_.check_step_m));
      for (int i = 0; i <= parts; ++i) {
        const Pose2 pose = piece.at(piece.length_m * i / parts);
        if (footprint_.is_free(pose)) continue;
        return fmt::format("the leg in alley {} is blocked: {}", leg.alley, tell_room(pose));
      }
    }
    return std::nullopt;
  }

  bool is_free(const Pieces& pieces) const {
    return std::all_of(pieces.begin(), pieces.end(), [&](const PathPiece& piece) {
      return footprint_.is_free_along(piece.start, piece.length_m, piece.curvature_per_m,
                                      params_.check_step_m);
    });
  }

  /// From where the vehicle stands to the first leg: straight on; or a short merge into the leg
  /// where it stands a little aside; else the search. A vehicle that stands on the leg begins
  /// there.
  std::optional<std::string> append_approach(const Pose2& pose, RouteLeg& leg, Pieces& pieces) {
    const Pose2 entry = leg.entry();
    const Eigen::Vector2d along = direction(entry.yaw_rad);
    const Eigen::Vector2d way = entry.p - pose.p;
    const double ahead_m = way.dot(along);
    const double first_m = (leg.line_W[1] - leg.line_W[0]).norm();
    const bool is_aligned =
        std::abs(wrap_angle(pose.yaw_rad - entry.yaw_rad)) < kAlongTheLine_rad &&
        std::abs(cross(along, way)) < kOnTheLine_m;
    if (is_aligned && std::abs(ahead_m) <= kOnTheLine_m) return std::nullopt;
    if (is_aligned && ahead_m < 0.0 && -ahead_m < first_m - kOnTheLine_m) {
      leg.line_W.front() = advance(entry, -ahead_m, 0.0).p;
      return std::nullopt;
    }
    if (is_aligned && ahead_m > 0.0 && std::abs(cross(along, way)) < kAlongTheLine_rad * ahead_m) {
      const PathPiece straight =
          make_straight(pose.p, entry.p, PathKind::kTransit, -1, params_.speed_mps);
      if (is_free({straight})) {
        pieces.push_back(straight);
        return std::nullopt;
      }
    }
    if (append_merge(pose, leg, first_m, pieces)) return std::nullopt;

    SearchReport done;
    const auto found = search_->find(pose, entry, footprint_, 0, done);
    count(done);
    if (!found) {
      return fmt::format("no way from the start at {} to the entrance of alley {} at {}: {}",
                         describe(pose), leg.alley, describe(entry), found.reason());
    }
    append_labelled(*found, PathKind::kTransit, pieces);
    return std::nullopt;
  }

  /// A Dubins path onto the leg that is hardly longer than the straight line.
  bool append_merge(const Pose2& pose, RouteLeg& leg, double first_m, Pieces& pieces) const {
    constexpr double kLongestMerge_m = 12.0, kStep_m = 0.5, kShareLonger = 0.05;
    const double longest_m = std::min(kLongestMerge_m, first_m - kStep_m);
    for (double s = 0.0; s <= longest_m; s += kStep_m) {
      const Pose2 joint = advance(leg.entry(), s, 0.0);
      const DubinsPath dubins = calc_dubins(pose, joint, params_.turning_radius_m);
      if (dubins.length_m() > (1.0 + kShareLonger) * (joint.p - pose.p).norm()) continue;
      Pieces merge;
      append_dubins(pose, dubins, PathKind::kTransit, params_.turn_speed_mps, merge);
      if (!is_free(merge)) continue;
      pieces.insert(pieces.end(), merge.begin(), merge.end());
      leg.line_W.front() = joint.p;
      return true;
    }
    return false;
  }

  std::optional<std::string> append_turn(const RouteLeg& from, const RouteLeg& to, int problem,
                                         Pieces& pieces) {
    SearchReport done;
    const auto found = search_->find(from.exit(), to.entry(), footprint_, problem, done);
    count(done);
    if (found) {
      append_labelled(*found, PathKind::kTurn, pieces);
      ++report_.numbers["turns"];
      if (done.first_length_m > 0.0) {
        report_.numbers["first_turn_length_m"] += done.first_length_m;
      }
      return std::nullopt;
    }
    const auto missing_m =
        calc_missing_clearance_m(from.exit(), to.entry(), params_.turning_radius_m, field_,
                                 footprint_.outline_B(), params_.margin_m);
    if (!missing_m) {
      return fmt::format("no free ground joins alley {} at {} and alley {} at {}: {}", from.alley,
                         describe(from.exit()), to.alley, describe(to.entry()), found.reason());
    }
    const Eigen::Vector2d size = calc_size(footprint_.outline_B());
    return fmt::format(
        "the turn from alley {} to alley {} needs {:.2f} m more room at the turning radius of "
        "{:.2f} m (footprint {:.1f} x {:.1f} m, margin {:.2f} m): {}",
        from.alley, to.alley, *missing_m, params_.turning_radius_m, size.x(), size.y(),
        params_.margin_m, found.reason());
  }

  void append_labelled(const Pieces& found, PathKind kind, Pieces& pieces) const {
    for (PathPiece piece : found) {
      piece.kind = kind;
      piece.speed_mps = params_.turn_speed_mps;
      pieces.push_back(piece);
    }
  }

  void count(const SearchReport& done) {
    report_.numbers["nodes"] += static_cast<double>(done.nodes);
    report_.numbers["iterations"] += static_cast<double>(done.iterations);
    for (const Eigen::Vector2d& p : done.tree_W) {
      report_.tree.points_W.emplace_back(p.x(), p.y(), 0.0);
    }
  }

  void count(const Pieces& pieces) {
    double least_m = std::numeric_limits<double>::infinity(), least_in_turns_m = least_m;
    for (const PathPiece& piece : pieces) {
      const double room_m = footprint_.clearance_along_m(
          piece.start, piece.length_m, piece.curvature_per_m, params_.check_step_m);
      least_m = std::min(least_m, room_m);
      if (piece.kind != PathKind::kTurn) continue;
      least_in_turns_m = std::min(least_in_turns_m, room_m);
      report_.numbers["turn_length_m"] += piece.length_m;
    }
    report_.numbers["length_m"] = calc_length_m(pieces);
    report_.numbers["clearance_m"] = least_m;
    if (report_.numbers["turns"] > 0.0) report_.numbers["turn_clearance_m"] = least_in_turns_m;
  }

  Result<PlannedPath> lift(double height_m, PlannedPath path) const {
    if (const auto fault = lift_to_ground(scene_, height_m, path)) return Failure{*fault};
    return path;
  }

  void lift_tree(double height_m) {
    constexpr double kAboveEverything_m = 1e4;
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
  DistanceField field_;
  Footprint footprint_;
  PlanReport report_;
};

}  // namespace

std::vector<ParameterSpec> route_planner_parameters() {
  std::vector<ParameterSpec> specs = row_route_parameters();
  for (ParameterSpec spec : {
           number_parameter("beyond_m", "m", 0.0, 0.0, 50.0,
                            "legs go this far beyond the row ends before and after a turn"),
           optional(positive_parameter("turning_radius_m", "m", 1.0,
                                       "least turning radius; default the vehicle's own")),
           number_parameter("margin_m", "m", 0.05, 0.0, 5.0,
                            "room that every planned pose keeps around the vehicle's outline"),
           positive_parameter("waypoint_pitch_m", "m", 0.25,
                              "straights and arcs are split into round(length / pitch) parts"),
           number_parameter("speed_mps", "m/s", 0.0, 0.0, 100.0,
                            "wanted speed on legs; 0 = the follower's own"),
           number_parameter("turn_speed_mps", "m/s", 0.0, 0.0, 100.0,
                            "wanted speed in turns; 0 = the follower's own"),
       }) {
    specs.push_back(std::move(spec));
  }
  return specs;
}

RoutePlannerParams read_route_planner_params(const ParameterSet& parameters,
                                             const PlannerContext& context,
                                             const std::string& who) {
  RoutePlannerParams params;
  const int alley_count = context.map == nullptr ? 0 : static_cast<int>(context.map->alleys.size());
  if (alley_count == 0) throw ConfigError(who + ": the map has no alleys to drive");
  params.route = read_row_route_params(parameters, alley_count, who);
  params.route.beyond_m = parameters.number("beyond_m");
  params.turning_radius_m = parameters.has("turning_radius_m")
                                ? parameters.number("turning_radius_m")
                                : context.vehicle_description->number("min_turning_radius_m", who);
  params.margin_m = parameters.number("margin_m");
  params.pitch_m = parameters.number("waypoint_pitch_m");
  params.speed_mps = parameters.number("speed_mps");
  params.turn_speed_mps = parameters.number("turn_speed_mps");
  return params;
}

std::unique_ptr<Planner> make_route_planner(const RoutePlannerParams& params,
                                            std::unique_ptr<PoseSearch> search,
                                            const PlannerContext& context) {
  if (context.map == nullptr || context.map->alleys.empty()) {
    throw ConfigError(context.part + ": the map has no alleys to drive");
  }
  if (context.map->occupancy.empty()) {
    throw ConfigError(context.part +
                      ": the map has no occupancy grid: set occupancy_cell_m");
  }
  return std::make_unique<RoutePlanner>(params, std::move(search), context);
}

}  // namespace vinerow
