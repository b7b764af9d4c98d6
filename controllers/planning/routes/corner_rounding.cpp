#include "controllers/planning/routes/corner_rounding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/dubins.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kSmooth_rad = rad_from_deg(5.0);
constexpr double kSlight_rad = rad_from_deg(30.0);
constexpr double kWidestArc_rad = rad_from_deg(120.0);
constexpr double kFits = 1.0 + 1e-9;

/// Passage of a corner, from cut_m before it to cut_m behind it.
struct Corner {
  enum class Shape { kAsItIs, kArc, kLoop } shape = Shape::kAsItIs;
  double cut_m = 0.0;
  double turn_rad = 0.0;
};

Corner plan_corner(double turn_rad, double available_m, double radius_m) {
  const double size_rad = std::abs(turn_rad);
  if (size_rad < kSmooth_rad) return {};
  const double wanted_m = radius_m * std::tan(0.5 * std::min(size_rad, kWidestArc_rad));
  const bool fits = size_rad <= kWidestArc_rad && wanted_m <= available_m * kFits;
  if (fits) return {Corner::Shape::kArc, wanted_m, turn_rad};
  if (size_rad < kSlight_rad) return {};
  return {Corner::Shape::kLoop, std::min(wanted_m, available_m), turn_rad};
}

/// Longest arc, so that its chord distinguishes it from its complement.
constexpr double kLongestArc_rad = rad_from_deg(60.0);

PathSegments split_arcs(const PathSegments& pieces) {
  PathSegments split;
  for (const PathSegment& piece : pieces) {
    const double angle_rad = std::abs(piece.curvature_per_m) * piece.length_m;
    const int parts = std::max(1, static_cast<int>(std::ceil(angle_rad / kLongestArc_rad)));
    PathSegment part = piece;
    part.length_m = piece.length_m / parts;
    for (int i = 0; i < parts; ++i) {
      part.start = piece.at(i * part.length_m);
      split.push_back(part);
    }
  }
  return split;
}

}  // namespace

RoundedPath round_corners(const std::vector<Eigen::Vector2d>& points,
                          const std::vector<double>& speed_mps, double radius_m, PathKind kind) {
  const std::size_t legs = points.size() - 1;
  std::vector<PathSegment> straights;
  for (std::size_t i = 0; i < legs; ++i) {
    straights.push_back(make_straight(points[i], points[i + 1], kind, -1, speed_mps[i]));
  }
  // Length of a leg that a corner may use: all of it if the other end is free, half if both ends
  // are corners.
  const auto available_m = [&](std::size_t leg) {
    const bool is_between = leg > 0 && leg + 1 < legs;
    return (is_between ? 0.5 : 1.0) * straights[leg].length_m;
  };
  RoundedPath rounded;
  double start_m = 0.0;  // of the leg's straight, behind the corner before
  for (std::size_t i = 0; i < legs; ++i) {
    Corner corner;
    if (i + 1 < legs) {
      const double turn_rad =
          wrap_angle(straights[i + 1].start.yaw_rad - straights[i].start.yaw_rad);
      corner = plan_corner(turn_rad, std::min(available_m(i), available_m(i + 1)), radius_m);
    }
    PathSegment straight = straights[i];
    straight.start = straights[i].at(start_m);
    straight.length_m = std::max(straights[i].length_m - corner.cut_m - start_m, 0.0);
    rounded.pieces.push_back(straight);
    start_m = corner.cut_m;
    const Pose2 from = straight.end();
    const double slow_mps = i + 1 < legs ? std::min(speed_mps[i], speed_mps[i + 1]) : 0.0;
    switch (corner.shape) {
      case Corner::Shape::kAsItIs:
        break;
      case Corner::Shape::kArc:
        rounded.pieces.push_back({from, radius_m * std::abs(corner.turn_rad),
                                  std::copysign(1.0 / radius_m, corner.turn_rad), PathKind::kTurn,
                                  -1, slow_mps});
        ++rounded.arcs;
        break;
      case Corner::Shape::kLoop:
        append_dubins(from, calc_dubins(from, straights[i + 1].at(corner.cut_m), radius_m),
                      PathKind::kTurn, slow_mps, rounded.pieces);
        ++rounded.loops;
        break;
    }
  }
  rounded.pieces = split_arcs(rounded.pieces);
  return rounded;
}

double find_corner_radius_m(const std::optional<double>& wanted_m,
                            const VehicleDescription& vehicle, const std::string& who) {
  constexpr double kReserve = 1.1;
  const double min_m = vehicle.steers_by_axles() ? vehicle.min_turning_radius_m.value_or(0.0) : 0.0;
  if (!wanted_m) return kReserve * min_m;
  if (*wanted_m >= min_m) return *wanted_m;
  throw ConfigError(
      fmt::format("{}: a turning radius of {:g} m is less than the {:.3f} m that vehicle type '{}' "
                  "can turn",
                  who, *wanted_m, min_m, vehicle.type));
}

}  // namespace vinerow::controllers
