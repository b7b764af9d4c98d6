#include "controllers/planning/search/shortcut.h"

#include <algorithm>
#include <cmath>

#include "controllers/planning/search/analytic_turn.h"

namespace vinerow::controllers {
namespace {

constexpr double kSaving_m = 0.01;
constexpr double kShortestPart_m = 0.5;
constexpr double kNothing_m = 1e-9;

/// Appends a piece; extends the last one if both have the same curvature.
void append(const PathSegment& piece, std::vector<PathSegment>& pieces) {
  if (piece.length_m < kNothing_m) return;
  if (!pieces.empty() && std::abs(pieces.back().curvature_per_m - piece.curvature_per_m) < 1e-12) {
    pieces.back().length_m += piece.length_m;
  } else {
    pieces.push_back(piece);
  }
}

/// Appends the part between two distances from the path's start.
void append_part(const std::vector<PathSegment>& path, double from_m, double to_m,
                 std::vector<PathSegment>& pieces) {
  double start_m = 0.0;
  for (const PathSegment& piece : path) {
    const double first_m = std::clamp(from_m - start_m, 0.0, piece.length_m);
    const double last_m = std::clamp(to_m - start_m, 0.0, piece.length_m);
    start_m += piece.length_m;
    if (last_m <= first_m) continue;
    PathSegment part = piece;
    if (first_m > 0.0) part.start = piece.at(first_m);
    part.length_m = last_m - first_m;
    append(part, pieces);
  }
}

Pose2 pose_at(const std::vector<PathSegment>& path, double distance_m) {
  for (const PathSegment& piece : path) {
    if (distance_m <= piece.length_m) return piece.at(distance_m);
    distance_m -= piece.length_m;
  }
  return path.back().end();
}

/// The shortest free Dubins path of any word, if it is shorter than the given length.
std::vector<PathSegment> find_shortcut(const Pose2& from, const Pose2& to, double shorter_than_m,
                                       const ShortcutParams& params, const Footprint& footprint) {
  std::vector<PathSegment> best, pieces;
  for (const DubinsWord word : kDubinsWords) {
    const DubinsPath dubins = calc_dubins_word(from, to, params.radius_m, word);
    if (dubins.length_m() >= shorter_than_m) continue;
    pieces.clear();
    append_dubins(from, dubins, PathKind::kTurn, 0.0, pieces);
    const bool is_free = std::all_of(pieces.begin(), pieces.end(), [&](const PathSegment& piece) {
      return footprint.is_free_along(piece.start, piece.length_m, piece.curvature_per_m,
                                     params.check_step_m);
    });
    if (!is_free) continue;
    shorter_than_m = dubins.length_m();
    best = pieces;
  }
  return best;
}

}  // namespace

std::vector<PathSegment> shorten_at_random(std::vector<PathSegment> pieces,
                                           const ShortcutParams& params, const Footprint& footprint,
                                           RandomStream& random) {
  double length_m = calc_length_m(pieces);
  const int tries = static_cast<int>(std::ceil(params.tries_per_m * length_m));
  for (int i = 0; i <= tries; ++i) {
    double from_m = 0.0, to_m = length_m;
    if (i > 0) {
      const double part_m =
          random.uniform(std::min(kShortestPart_m, length_m), std::min(params.longest_m, length_m));
      from_m = random.uniform(0.0, length_m - part_m);
      to_m = from_m + part_m;
    }
    const Pose2 from = pose_at(pieces, from_m), to = pose_at(pieces, to_m);
    const std::vector<PathSegment> shortcut =
        find_shortcut(from, to, to_m - from_m - kSaving_m, params, footprint);
    if (shortcut.empty()) continue;
    std::vector<PathSegment> shorter;
    append_part(pieces, 0.0, from_m, shorter);
    for (const PathSegment& piece : shortcut) append(piece, shorter);
    append_part(pieces, to_m, length_m, shorter);
    pieces = std::move(shorter);
    length_m = calc_length_m(pieces);
  }
  return pieces;
}

}  // namespace vinerow::controllers
