#include "controllers/planning/routes/coverage_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/parts/paths/footprint.h"
#include "controllers/parts/paths/lift.h"
#include "controllers/planning/routes/corner_rounding.h"
#include "controllers/planning/routes/headland_turn.h"
#include "controllers/planning/routes/row_check.h"
#include "controllers/planning/routes/row_route.h"
#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

struct CoverageParams {
  double pitch_m = 0.33;
  TurnParams turn;
  std::optional<double> turn_radius_m;  ///< absent: from the vehicle, at least 1 m
  RowRouteParams route;
  double speed_mps = 0.0;
  double lead_in_m = 0.0;
  double lead_out_m = 0.0;
  double clearance_m = 0.0;
  bool approach = true;
};

const ParameterTable<CoverageParams>& coverage_table() {
  using P = CoverageParams;
  const auto turn = [](auto member) { return inside(&P::turn, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("waypoint_pitch_m", "m", &P::pitch_m, kPositive,
                  "waypoint pitch WPP: straights and arcs are split into round(length / "
                  "pitch) parts")
          .choice("turn", turn(&TurnParams::kind),
                  {{"three_point_arc", TurnKind::kThreePointArc}, {"dubins", TurnKind::kDubins}},
                  "path from one alley to the next")
          .number("turn_radius_m", "m", &P::turn_radius_m, kPositive,
                  "radius of Dubins arcs; minimum radius of three-point arcs; default 1.1 times "
                  "the minimum of a vehicle with axle steering, else 1 (table 1)")
          .number("headland_m", "m", turn(&TurnParams::headland_m), between(0.0, 1e3),
                  "straight beyond the alley's end before turning, and before entering")
          .number("apex_m", "m", turn(&TurnParams::apex_m), kPositive,
                  "apex of the three-point arc beyond the alley ends; default half "
                  "the alley spacing, a semicircle")
          .number("speed_mps", "m/s", &P::speed_mps, between(0.0, 100.0),
                  "wanted speed on legs; 0 = the follower's own")
          .number("turn_speed_mps", "m/s", turn(&TurnParams::speed_mps), between(0.0, 100.0),
                  "wanted speed in turns; 0 = the follower's own")
          .number("lead_in_m", "m", &P::lead_in_m, between(0.0, 1e3),
                  "straight before the first alley")
          .number("lead_out_m", "m", &P::lead_out_m, between(0.0, 1e3),
                  "straight beyond the last alley")
          .boolean("approach", &P::approach,
                   "plan the path from the vehicle's position to the first alley")
          .number("clearance_m", "m", &P::clearance_m, between(0.0, 10.0),
                  "distance that the planned line keeps from every canopy's footprint")
          .include(&P::route, row_route_table());
  return table;
}

class Coverage final : public Planner {
 public:
  Coverage(const CoverageParams& params, const PlannerContext& context)
      : params_(params),
        map_(*context.map),
        scene_(context.scene),
        vehicle_(*context.vehicle_description) {}

  Result<PlannedPath> plan(const Pose& start) override {
    const Pose2 pose = {start.p.head<2>(), yaw_from_quaternion(start.q)};
    const auto legs = make_row_route(map_, params_.route, pose.p);
    if (!legs) return Failure{legs.reason()};

    std::vector<PathSegment> pieces;
    std::size_t approach_pieces = 0;
    Pose2 at = pose;  // pose of the vehicle after the pieces so far
    for (std::size_t i = 0; i < legs->size(); ++i) {
      const RouteLeg& leg = (*legs)[i];
      if (i == 0) {
        append_approach(pose, leg.entry(), pieces);
        approach_pieces = pieces.size();
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
    if (const auto fault = find_path_into_row(path, map_, params_.clearance_m, &vehicle_)) {
      pieces.resize(approach_pieces);
      return Failure{*fault + advise_on_approach(pose, legs->front().alley, pieces)};
    }
    if (const auto fault = lift_to_ground(scene_, start.p.z(), path)) return Failure{*fault};
    return path;
  }

 private:
  /// What to do if the way to the first alley is what meets a row, else "".
  std::string advise_on_approach(const Pose2& pose, int alley,
                                 const std::vector<PathSegment>& approach) const {
    if (approach.empty()) return "";
    const PlannedPath way = make_planned_path(approach, params_.pitch_m);
    if (!find_path_into_row(way, map_, params_.clearance_m, &vehicle_)) return "";
    return fmt::format(
        ", on the way to alley {} from the estimated start {}: start on the alley's line, estimate "
        "the start better, or leave the way to the follower by approach: false",
        alley, to_string(pose));
  }

  /// Appends the path from the vehicle's pose to the first alley: a straight if it leads there,
  /// else a Dubins path; then the lead-in.
  void append_approach(const Pose2& pose, const Pose2& entry,
                       std::vector<PathSegment>& pieces) const {
    const Pose2 begin = advance(entry, -params_.lead_in_m, 0.0);
    const Eigen::Vector2d offset = begin.p - pose.p;
    const Eigen::Vector2d along = direction(begin.yaw_rad);
    constexpr double kOnTheLine_m = 0.05, kHeadingSlack_rad = 0.1;
    const bool is_aligned =
        std::abs(wrap_angle(pose.yaw_rad - begin.yaw_rad)) < kHeadingSlack_rad &&
        std::abs(cross(along, offset)) < kOnTheLine_m && offset.dot(along) > -kOnTheLine_m;
    if (params_.approach && is_aligned) {
      if (offset.norm() > kOnTheLine_m) {
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
  const VehicleDescription& vehicle_;
};

}  // namespace

PartSpec coverage_spec() {
  PartSpec spec;
  spec.name = "coverage";
  spec.description =
      "Path along the alleys of the row map with straight legs and headland turns (Martelli, "
      "Mocera, Soma 2024, section 2.3): three-point arcs or Dubins paths, split at the waypoint "
      "pitch.";
  coverage_table().add_to(spec);
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
  const std::string who = context.part + " (coverage)";
  CoverageParams params = coverage_table().read(parameters, who);
  const double radius_m =
      find_corner_radius_m(params.turn_radius_m, *context.vehicle_description, who);
  params.turn.radius_m = params.turn_radius_m ? radius_m : std::max(radius_m, 1.0);
  params.route.demand_alleys(alley_count, who);
  return std::make_unique<Coverage>(params, context);
}

}  // namespace vinerow::controllers
