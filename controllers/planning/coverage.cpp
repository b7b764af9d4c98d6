#include "controllers/planning/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/planning/headland_turn.h"
#include "controllers/planning/lift.h"
#include "controllers/planning/row_check.h"
#include "controllers/planning/row_route.h"
#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

struct CoverageParams {
  double pitch_m;
  TurnParams turn;
  RowRouteParams route;
  double speed_mps;
  double lead_in_m;
  double lead_out_m;
  double clearance_m;
  bool approach;
};

CoverageParams read_params(const ParameterSet& parameters, const std::string& who,
                           int alley_count) {
  CoverageParams params;
  params.pitch_m = parameters.number("waypoint_pitch_m");
  params.turn.kind =
      parameters.text("turn") == "dubins" ? TurnKind::kDubins : TurnKind::kThreePointArc;
  params.turn.radius_m = parameters.number("turn_radius_m");
  params.turn.headland_m = parameters.number("headland_m");
  if (parameters.has("apex_m")) params.turn.apex_m = parameters.number("apex_m");
  params.turn.speed_mps = parameters.number("turn_speed_mps");
  params.route = read_row_route_params(parameters, alley_count, who);
  params.speed_mps = parameters.number("speed_mps");
  params.lead_in_m = parameters.number("lead_in_m");
  params.lead_out_m = parameters.number("lead_out_m");
  params.clearance_m = parameters.number("clearance_m");
  params.approach = parameters.boolean("approach");
  return params;
}

class Coverage final : public Planner {
 public:
  Coverage(const CoverageParams& params, const PlannerContext& context)
      : params_(params), map_(*context.map), scene_(context.scene) {}

  Result<PlannedPath> plan(const Pose& start) override {
    const Pose2 pose = {start.p.head<2>(), yaw_from_quaternion(start.q)};
    const auto legs = make_row_route(map_, params_.route, pose.p);
    if (!legs) return Failure{legs.reason()};

    std::vector<PathPiece> pieces;
    Pose2 at = pose;  // where the vehicle is after the pieces so far
    for (std::size_t i = 0; i < legs->size(); ++i) {
      const RouteLeg& leg = (*legs)[i];
      if (i == 0) {
        append_approach(pose, leg.entry(), pieces);
      } else {
        const auto turn = make_headland_turn(at, leg.entry(), params_.turn);
        if (!turn) {
          return Failure{fmt::format("turn from alley {} to alley {}: {}", (*legs)[i - 1].alley,
                                     leg.alley, turn.reason())};
        }
        pieces.insert(pieces.end(), turn->begin(), turn->end());
      }
      append_leg(leg, params_.speed_mps, pieces);
      at = pieces.back().end();
    }
    if (params_.lead_out_m > 0.0) {
      pieces.push_back({at, params_.lead_out_m, 0.0, PathKind::kTransit, -1, params_.speed_mps});
    }

    PlannedPath path = make_planned_path(pieces, params_.pitch_m);
    if (const auto fault = find_path_into_row(path, map_, params_.clearance_m)) {
      return Failure{*fault};
    }
    if (const auto fault = lift_to_ground(scene_, start.p.z(), path)) return Failure{*fault};
    return path;
  }

 private:
  /// From where the vehicle stands to the first alley: straight on if that leads there, else a
  /// Dubins path; then the lead-in.
  void append_approach(const Pose2& pose, const Pose2& entry,
                       std::vector<PathPiece>& pieces) const {
    const Pose2 begin = advance(entry, -params_.lead_in_m, 0.0);
    const Eigen::Vector2d way = begin.p - pose.p;
    const Eigen::Vector2d along = direction(begin.yaw_rad);
    constexpr double kOnTheLine_m = 0.05, kHeadingSlack_rad = 0.1;
    const bool is_aligned =
        std::abs(wrap_angle(pose.yaw_rad - begin.yaw_rad)) < kHeadingSlack_rad &&
        std::abs(cross(along, way)) < kOnTheLine_m && way.dot(along) > -kOnTheLine_m;
    if (params_.approach && is_aligned) {
      if (way.norm() > kOnTheLine_m) {
        pieces.push_back(make_straight(pose.p, begin.p, PathKind::kTransit, -1, params_.speed_mps));
      }
    } else if (params_.approach) {
      append_dubins(pose, calc_dubins(pose, begin, params_.turn.radius_m), PathKind::kTransit,
                    params_.turn.speed_mps, pieces);
    }
    if (params_.lead_in_m > 0.0) {
      pieces.push_back({begin, params_.lead_in_m, 0.0, PathKind::kTransit, -1, params_.speed_mps});
    }
  }

  CoverageParams params_;
  const RowMap& map_;
  const SceneQuery* scene_;
};

}  // namespace

PartSpec coverage_spec() {
  PartSpec spec;
  spec.name = "coverage";
  spec.description =
      "Drives the alleys of the row map with straight legs and headland turns (Martelli, Mocera, "
      "Soma 2024, section 2.3): three-point arcs or Dubins paths, split at the waypoint pitch.";
  spec.parameters = {
      positive_parameter("waypoint_pitch_m", "m", 0.33,
                         "waypoint pitch WPP: straights and arcs are split into round(length / "
                         "pitch) parts"),
      choice_parameter("turn", "three_point_arc", {"three_point_arc", "dubins"},
                       "how to get from one alley to the next"),
      positive_parameter(
          "turn_radius_m", "m", 1.0,
          "radius of Dubins arcs; least radius allowed for three-point arcs (table 1)"),
      number_parameter("headland_m", "m", 0.0, 0.0, 1e3,
                       "straight on beyond the alley's end before turning, and before entering"),
      optional(positive_parameter("apex_m", "m", 5.0,
                                  "apex of the three-point arc beyond the alley ends; default half "
                                  "the alley spacing, a semicircle")),
      number_parameter("speed_mps", "m/s", 0.0, 0.0, 100.0,
                       "wanted speed on legs; 0 = the follower's own"),
      number_parameter("turn_speed_mps", "m/s", 0.0, 0.0, 100.0,
                       "wanted speed in turns; 0 = the follower's own"),
      number_parameter("lead_in_m", "m", 0.0, 0.0, 1e3, "straight before the first alley"),
      number_parameter("lead_out_m", "m", 0.0, 0.0, 1e3, "straight beyond the last alley"),
      boolean_parameter("approach", true,
                        "plan the way from where the vehicle stands to the first alley"),
      number_parameter("clearance_m", "m", 0.0, 0.0, 10.0,
                       "distance that the planned line keeps from every canopy's footprint"),
  };
  for (ParameterSpec& parameter : row_route_parameters()) spec.parameters.push_back(parameter);
  spec.reads = {"estimate"};
  spec.writes = {"plan"};
  return spec;
}

std::unique_ptr<Planner> make_coverage(const ParameterSet& parameters,
                                       const PlannerContext& context) {
  if (context.map == nullptr || context.map->alleys.empty()) {
    throw ConfigError(fmt::format("{} (coverage): the map has no alleys to drive", context.part));
  }
  const int alley_count = static_cast<int>(context.map->alleys.size());
  return std::make_unique<Coverage>(
      read_params(parameters, context.part + " (coverage)", alley_count), context);
}

}  // namespace vinerow
