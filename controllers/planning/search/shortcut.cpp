#include "controllers/planning/search/shortcut.h"

#include <algorithm>
#include <cmath>

#include "controllers/planning/search/analytic_turn.h"

namespace vinerow::controllers {
namespace {

constexpr double kSaving_m = 0.01;
constexpr double kShortestPart_m = 0.5;
constexpr double kNothing_m = 1e-9;

/// Appends a piece, to the last one where both bend alike.
void append(const PathPiece& piece, std::vector<PathPiece>& pieces) {
  if (piece.length_m < kNothing_m) return;
  if (!pieces.empty() && std::abs(pieces.back().curvature_per_m - piece.curvature_per_m) < 1e-12) {
    pieces.back().length_m += piece.length_m;
  } else {
    pieces.push_back(piece);
  }
}

/// Appends what lies between two distances from the path's start.
void append_part(const std::vector<PathPiece>& path, double from_m, double to_m,
                 std::vector<PathPiece>& pieces) {
  double begin_m = 0.0;
  for (const PathPiece& piece : path) {
    const double first_m = std::clamp(from_m - begin_m, 0.0, piece.length_m);
    const double last_m = std::clamp(to_m - begin_m, 0.0, piece.length_m);
    begin_m += piece.length_m;
    if (last_m <= first_m) continue;
    PathPiece part = piece;
    if (first_m > 0.0) part.start = piece.at(first_m);
    part.length_m = last_m - first_m;
    append(part, pieces);
  }
}

Pose2 pose_at(const std::vector<PathPiece>& path, double distance_m) {
  for (const PathPiece& piece : path) {
    if (distance_m <= piece.length_m) return piece.at(distance_m);
    distance_m -= piece.length_m;
  }
  return path.back().end();
}

/// The shortest free Dubins path of any word, if it is shorter than that.
std::vector<PathPiece> find_shortcut(const Pose2& from, const Pose2& to, double shorter_than_m,
                                     const ShortcutParams& params, const Footprint& footprint) {
  std::vector<PathPiece> best, pieces;
  for (const DubinsWord word : kDubinsWords) {
    const DubinsPath dubins = calc_dubins_word(from, to, params.radius_m, word);
    if (dubins.length_m() >= shorter_than_m) continue;
    pieces.clear();
    append_dubins(from, dubins, PathKind::kTurn, 0.0, pieces);
    const bool is_free = std::all_of(pieces.begin(), pieces.end(), [&](const PathPiece& piece) {
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

std::vector<PathPiece> shorten_at_random(std::vector<PathPiece> pieces,
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
    const std::vector<PathPiece> shortcut =
        find_shortcut(from, to, to_m - from_m - kSaving_m, params, footprint);
    if (shortcut.empty()) continue;
    std::vector<PathPiece> shorter;
    append_part(pieces, 0.0, from_m, shorter);
    for (const PathPiece& piece : shortcut) append(piece, shorter);
    append_part(pieces, to_m, length_m, shorter);
    pieces = std::move(shorter);
    length_m = calc_length_m(pieces);
  }
  return pieces;
}

}  // namespace vinerow::controllers
