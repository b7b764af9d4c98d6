#include "controllers/planning/routes/leg_detour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "controllers/planning/search/analytic_turn.h"

namespace vinerow::controllers {
namespace {

/// Part of a sequence of straights.
PathSegments cut(const PathSegments& pieces, double from_m, double to_m) {
  constexpr double kShortest_m = 1e-6;
  PathSegments part;
  double start_m = 0.0;
  for (const PathSegment& piece : pieces) {
    const double first_m = std::clamp(from_m - start_m, 0.0, piece.length_m);
    const double last_m = std::clamp(to_m - start_m, 0.0, piece.length_m);
    start_m += piece.length_m;
    if (last_m - first_m < kShortest_m) continue;
    PathSegment some = piece;
    some.start = piece.at(first_m);
    some.length_m = last_m - first_m;
    part.push_back(some);
  }
  return part;
}

Pose2 pose_on(const PathSegments& pieces, double distance_m) {
  for (const PathSegment& piece : pieces) {
    if (distance_m <= piece.length_m) return piece.at(distance_m);
    distance_m -= piece.length_m;
  }
  return pieces.back().end();
}

struct Stretch {
  double from_m = 0.0, to_m = 0.0;
};

std::vector<Stretch> find_blocked(const PathSegments& pieces, const Footprint& footprint,
                                  double step_m) {
  const double length_m = calc_length_m(pieces);
  const int parts = std::max(1, static_cast<int>(std::ceil(length_m / step_m)));
  std::vector<Stretch> blocked;
  bool was_free = true;
  for (int i = 0; i <= parts; ++i) {
    const double s = length_m * i / parts;
    const bool is_free = footprint.is_free(pose_on(pieces, s));
    if (!is_free && was_free) blocked.push_back({s, s});
    if (!is_free) blocked.back().to_m = s;
    was_free = is_free;
  }
  return blocked;
}

}  // namespace

Result<PathSegments> drive_around(const RouteLeg& leg, const Footprint& footprint,
                                  const RouteClearance& clearance, PoseSearch& search, int problem,
                                  const LegDetourParams& params,
                                  std::vector<SearchReport>& reports) {
  PathSegments straights;
  append_leg(leg, params.speed_mps, straights);
  const double length_m = calc_length_m(straights);
  PathSegments path;
  double at_m = 0.0;
  for (const Stretch& stretch : find_blocked(straights, footprint, params.step_m)) {
    if (stretch.from_m < at_m) continue;  // already passed with the stretch before
    // A swerve by d takes a length of about 2 sqrt(R d). Longer ones are tried in turn.
    constexpr double kRadii[] = {2.0, 3.5, 5.0};
    std::optional<PathSegments> found;
    std::string reason = "it is at the leg's end";
    for (const double radii : kRadii) {
      const double from_m = std::max(at_m, stretch.from_m - radii * params.radius_m);
      const double to_m = std::min(length_m, stretch.to_m + radii * params.radius_m);
      const Pose2 from = pose_on(straights, from_m), to = pose_on(straights, to_m);
      if (!footprint.is_free(from) || !footprint.is_free(to)) continue;
      reports.emplace_back();
      const auto outcome = search.find(from, to, footprint, problem++, reports.back());
      if (!outcome) {
        reason = outcome.reason();
        continue;
      }
      PathSegments swerve = *outcome;
      if (!clearance.is_free(swerve)) {
        reason = "the path found touches it";
        continue;
      }
      for (PathSegment& piece : swerve) {
        piece.kind = PathKind::kLeg;
        piece.alley = leg.alley;
        piece.speed_mps = params.speed_mps;
      }
      // Reject a loop through the neighbouring alley.
      constexpr double kLonger = 1.5;
      if (calc_length_m(swerve) > kLonger * (to_m - from_m)) {
        reason = fmt::format("the shortest path found takes {:.1f} m for {:.1f} m",
                             calc_length_m(swerve), to_m - from_m);
        continue;
      }
      found = cut(straights, at_m, from_m);
      found->insert(found->end(), swerve.begin(), swerve.end());
      at_m = to_m;
      break;
    }
    if (!found) {
      return Failure{fmt::format("the leg in alley {} is blocked: {}; no path around it: {}",
                                 leg.alley, clearance.describe(pose_on(straights, stretch.from_m)),
                                 reason)};
    }
    path.insert(path.end(), found->begin(), found->end());
  }
  const PathSegments rest = cut(straights, at_m, length_m);
  path.insert(path.end(), rest.begin(), rest.end());
  return path;
}

}  // namespace vinerow::controllers
