#include "controllers/planning/routes/headland_turn.h"

#include <fmt/format.h>

#include <algorithm>

#include "controllers/parts/paths/arc3.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kShortestTurn_m = 1e-9;

Result<std::vector<PathSegment>> make_three_point_arc(const Pose2& exit, const Pose2& entry,
                                                      const TurnParams& params) {
  const Eigen::Vector2d out = direction(exit.yaw_rad), in = direction(entry.yaw_rad);
  if (out.dot(in) > -0.5) {
    return Failure{fmt::format(
        "a three-point arc joins alleys that are driven in opposite directions; use {}: dubins",
        params.kind_key)};
  }
  // If one alley ends before the other, its straight is extended, so that the arc starts and ends
  // level and meets both legs smoothly.
  const Eigen::Vector2d axis = (out - in).normalized();
  const double step = axis.dot(entry.p - exit.p);
  const Eigen::Vector2d a = exit.p + (params.headland_m + std::max(step, 0.0)) * out;
  const Eigen::Vector2d c = entry.p - (params.headland_m + std::max(-step, 0.0)) * in;
  const double half_spacing = 0.5 * (c - a).norm();
  const Eigen::Vector2d apex = 0.5 * (a + c) + params.apex_m.value_or(half_spacing) * axis;

  const Result<Arc3> arc = make_arc3(a, apex, c);
  if (!arc) return Failure{arc.reason()};
  if (arc->radius_m() < params.radius_m * (1.0 - 1e-9)) {
    return Failure{fmt::format(
        "the three-point arc between alleys {:.3g} m apart has a radius of {:.3g} m, below "
        "{} = {:.3g} m; use {}: dubins, whose loop fits any spacing{}",
        2.0 * half_spacing, arc->radius_m(), params.radius_key, params.radius_m, params.kind_key,
        params.other)};
  }
  std::vector<PathSegment> pieces;
  const auto add_straight = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    if ((to - from).norm() > kShortestTurn_m) {
      pieces.push_back(make_straight(from, to, PathKind::kTurn, -1, params.speed_mps));
    }
  };
  add_straight(exit.p, a);
  pieces.push_back(
      {arc->start, arc->length_m, arc->curvature_per_m, PathKind::kTurn, -1, params.speed_mps});
  add_straight(c, entry.p);
  return pieces;
}

std::vector<PathSegment> make_dubins_turn(const Pose2& exit, const Pose2& entry,
                                          const TurnParams& params) {
  std::vector<PathSegment> pieces;
  const Pose2 from = advance(exit, params.headland_m, 0.0);
  const Pose2 to = advance(entry, -params.headland_m, 0.0);
  if (params.headland_m > kShortestTurn_m) {
    pieces.push_back(make_straight(exit.p, from.p, PathKind::kTurn, -1, params.speed_mps));
  }
  append_dubins(from, calc_dubins(from, to, params.radius_m), PathKind::kTurn, params.speed_mps,
                pieces);
  if (params.headland_m > kShortestTurn_m) {
    pieces.push_back(make_straight(to.p, entry.p, PathKind::kTurn, -1, params.speed_mps));
  }
  return pieces;
}

}  // namespace

Result<std::vector<PathSegment>> make_headland_turn(const Pose2& exit, const Pose2& entry,
                                                    const TurnParams& params) {
  if (params.kind == TurnKind::kDubins) return make_dubins_turn(exit, entry, params);
  return make_three_point_arc(exit, entry, params);
}

}  // namespace vinerow::controllers
