#include "controllers/planning/flight/flight_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "controllers/parts/paths/lift.h"
#include "controllers/planning/routes/route_clearance.h"
#include "controllers/planning/routes/row_check.h"
#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kOnLeg_m = 0.05;
constexpr double kCheckPitch_m = 0.25;

/// Coordinates of a point relative to the first straight of a leg: distance along it and to its
/// left.
Eigen::Vector2d place_along(const RouteLeg& leg, const Eigen::Vector2d& p) {
  const Pose2 entry = leg.entry();
  const Eigen::Vector2d along = direction(entry.yaw_rad), offset = p - entry.p;
  return {offset.dot(along), cross(along, offset)};
}

double first_length_m(const RouteLeg& leg) {
  return (leg.line_W[1] - leg.line_W[0]).norm();
}

/// The point on the leg's line next to a vehicle that is in that alley: a flying vehicle moves
/// sideways and need not return to the entrance.
std::optional<Eigen::Vector2d> find_place_on_leg(const RouteLeg& leg, const RowMap& map,
                                                 const Eigen::Vector2d& start) {
  const Eigen::Vector2d place = place_along(leg, start);
  const auto alley = std::find_if(map.alleys.begin(), map.alleys.end(),
                                  [&](const Alley& one) { return one.id == leg.alley; });
  const double reach_m = alley == map.alleys.end() ? 0.0 : 0.5 * alley->width_m;
  if (std::abs(place.y()) > std::max(reach_m, kOnLeg_m) || place.x() < -kOnLeg_m ||
      place.x() > first_length_m(leg) - kOnLeg_m) {
    return std::nullopt;
  }
  return leg.entry().p + std::max(place.x(), 0.0) * direction(leg.entry().yaw_rad);
}

class GridPath final : public RowPathPlanner {
 public:
  GridPath(const RoutePlannerParams& params, std::unique_ptr<PoseSearch> search,
           const PlannerContext& context)
      : params_(params),
        map_(*context.map),
        field_(std::make_shared<const DistanceField>(map_.occupancy)),
        footprint_(*field_, context.vehicle_description->outline_B(), params.margin_m),
        clearance_(map_, footprint_, params.check_step_m),
        planner_(make_route_planner(params, std::move(search), context, field_)) {}

  Result<PlannedPath> plan(const Eigen::Vector3d& start_W) override {
    const auto legs = make_row_route(map_, params_.route, start_W.head<2>());
    if (!legs) return Failure{legs.reason()};
    if (const auto on_leg = find_place_on_leg(legs->front(), map_, start_W.head<2>())) {
      const double along_rad = legs->front().entry().yaw_rad;
      return planner_->plan({quaternion_from_rpy({0.0, 0.0, along_rad}),
                             Eigen::Vector3d(on_leg->x(), on_leg->y(), start_W.z())});
    }
    const double yaw_rad =
        choose_heading(start_W.head<2>(), legs->front(), params_.turning_radius_m,
                       [this](const PathSegments& pieces) { return clearance_.is_free(pieces); });
    return planner_->plan({quaternion_from_rpy({0.0, 0.0, yaw_rad}), start_W});
  }

  const PlanReport* report() const override { return planner_->report(); }

 private:
  RoutePlannerParams params_;
  const RowMap& map_;
  std::shared_ptr<const DistanceField> field_;
  Footprint footprint_;
  RouteClearance clearance_;
  std::unique_ptr<Planner> planner_;
};

class ClosedFormPath final : public RowPathPlanner {
 public:
  ClosedFormPath(const RoutePlannerParams& params, TurnKind turns, double reach_m,
                 const PlannerContext& context)
      : params_(params), reach_m_(reach_m), map_(*context.map), scene_(context.scene) {
    turn_.kind = turns;
    turn_.radius_m = params.turning_radius_m;
    turn_.radius_key = "turning_radius_m";
    turn_.kind_key = "turns";
    turn_.other = "";
    turn_.speed_mps = params.turn_speed_mps;
  }

  Result<PlannedPath> plan(const Eigen::Vector3d& start_W) override {
    report_ = {};
    auto legs = make_row_route(map_, params_.route, start_W.head<2>());
    if (!legs) return Failure{legs.reason()};
    std::vector<RouteLeg> route = *legs;
    PathSegments pieces;
    append_approach(start_W.head<2>(), route.front(), pieces);
    for (std::size_t i = 0; i < route.size(); ++i) {
      if (i > 0) {
        const auto turn = make_headland_turn(pieces.back().end(), route[i].entry(), turn_);
        if (!turn) {
          return Failure{fmt::format("turn from alley {} to alley {}: {}", route[i - 1].alley,
                                     route[i].alley, turn.reason())};
        }
        for (const PathSegment& piece : *turn) {
          report_.numbers["turn_length_m"] += piece.length_m;
          pieces.push_back(piece);
        }
      }
      append_leg(route[i], params_.speed_mps, pieces);
    }
    report_.numbers["turns"] = static_cast<double>(route.size() - 1);
    PlannedPath path = make_planned_path(pieces, params_.pitch_m);
    if (const auto fault = find_path_into_row(path, map_, reach_m_)) return Failure{*fault};
    if (const auto fault = lift_to_ground(scene_, start_W.z(), path)) return Failure{*fault};
    return path;
  }

  const PlanReport* report() const override { return &report_; }

 private:
  bool is_free(const PathSegments& pieces) const {
    return !find_path_into_row(make_planned_path(pieces, kCheckPitch_m), map_, reach_m_);
  }

  /// Appends a Dubins path; nothing if the vehicle is in the alley, whose leg then starts next to
  /// it.
  void append_approach(const Eigen::Vector2d& start, RouteLeg& leg, PathSegments& pieces) const {
    if (const auto on_leg = find_place_on_leg(leg, map_, start)) {
      leg.line_W.front() = *on_leg;
      return;
    }
    const double yaw_rad =
        choose_heading(start, leg, params_.turning_radius_m,
                       [this](const PathSegments& candidate) { return is_free(candidate); });
    append_dubins({start, yaw_rad},
                  calc_dubins({start, yaw_rad}, leg.entry(), params_.turning_radius_m),
                  PathKind::kTransit, params_.speed_mps, pieces);
  }

  RoutePlannerParams params_;
  TurnParams turn_;
  double reach_m_;
  const RowMap& map_;
  const SceneQuery* scene_;
  PlanReport report_;
};

}  // namespace

std::unique_ptr<RowPathPlanner> make_grid_path(const RoutePlannerParams& params,
                                               std::unique_ptr<PoseSearch> search,
                                               const PlannerContext& context) {
  if (context.map == nullptr || context.map->occupancy.empty()) {
    throw ConfigError(context.part +
                      " (row_flight): the map has no occupancy grid: set occupancy_cell_m, or "
                      "turns: dubins");
  }
  return std::make_unique<GridPath>(params, std::move(search), context);
}

std::unique_ptr<RowPathPlanner> make_closed_form_path(const RoutePlannerParams& params,
                                                      TurnKind turns, double reach_m,
                                                      const PlannerContext& context) {
  return std::make_unique<ClosedFormPath>(params, turns, reach_m, context);
}

double choose_heading(const Eigen::Vector2d& start, const RouteLeg& first, double radius_m,
                      const std::function<bool(const std::vector<PathSegment>&)>& is_free) {
  constexpr int kHeadings = 72;
  const Pose2 entry = first.entry();
  const Eigen::Vector2d place = place_along(first, start), offset = entry.p - start;
  if (std::abs(place.y()) < kOnLeg_m && place.x() < first_length_m(first)) {
    return entry.yaw_rad;
  }
  std::vector<std::pair<double, double>> candidates;  // length, heading
  const auto add = [&](double yaw_rad) {
    candidates.emplace_back(calc_dubins({start, yaw_rad}, entry, radius_m).length_m(), yaw_rad);
  };
  add(std::atan2(offset.y(), offset.x()));
  for (int i = 0; i < kHeadings; ++i) add(wrap_angle(entry.yaw_rad + 2.0 * kPi * i / kHeadings));
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first - 1e-9; });
  for (const auto& [length_m, yaw_rad] : candidates) {
    PathSegments pieces;
    append_dubins({start, yaw_rad}, calc_dubins({start, yaw_rad}, entry, radius_m),
                  PathKind::kTransit, 0.0, pieces);
    if (is_free(pieces)) return yaw_rad;
  }
  return candidates.front().second;
}

}  // namespace vinerow::controllers
