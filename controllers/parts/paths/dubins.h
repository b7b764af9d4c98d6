#pragma once
/// Shortest paths of a vehicle that drives forward with a minimum turning radius.
///
/// Source: Dubins, "On curves of minimal length with a constraint on average curvature...", Am. J.
/// Math. 79, 1957: the shortest path is one of six words of three pieces, LSL RSR LSR RSL RLR LRL.
/// Closed form from the centres of the turning circles (derivation in the source file), valid for
/// every pair of poses, equal poses and opposite headings included. No heap, cannot fail.

#include <array>
#include <limits>

#include "controllers/parts/paths/pose2.h"

namespace vinerow::controllers {

enum class DubinsWord { kLSL, kRSR, kLSR, kRSL, kRLR, kLRL };
constexpr std::array<DubinsWord, 6> kDubinsWords = {DubinsWord::kLSL, DubinsWord::kRSR,
                                                    DubinsWord::kLSR, DubinsWord::kRSL,
                                                    DubinsWord::kRLR, DubinsWord::kLRL};
const char* to_string(DubinsWord word);

struct DubinsPath {
  struct Piece {
    double length_m = 0.0;         ///< >= 0
    double curvature_per_m = 0.0;  ///< +1/radius (L), -1/radius (R) or 0 (S)
  };
  DubinsWord word = DubinsWord::kLSL;
  bool exists = false;
  std::array<Piece, 3> pieces;

  double length_m() const {
    return exists ? pieces[0].length_m + pieces[1].length_m + pieces[2].length_m
                  : std::numeric_limits<double>::infinity();
  }
};

/// The shortest path of one word; `exists` is false if the word cannot join the poses.
/// @param radius_m  > 0
DubinsPath calc_dubins_word(const Pose2& start, const Pose2& goal, double radius_m,
                            DubinsWord word);

/// The shortest of all six; if several are equal (within 1e-9 of the radius), the first in
/// kDubinsWords.
DubinsPath calc_dubins(const Pose2& start, const Pose2& goal, double radius_m);

/// Pose after `length_m` of the path, from its start.
Pose2 pose_on_dubins(const Pose2& start, const DubinsPath& path, double length_m);

}  // namespace vinerow::controllers
