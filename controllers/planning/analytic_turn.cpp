#include "controllers/planning/analytic_turn.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vinerow {
namespace {

struct Candidate {
  double length_m;
  double out_m;
  double in_m;
  DubinsPath dubins;
};

constexpr double kShortest_m = 1e-9;

}  // namespace

std::vector<std::vector<PathPiece>> make_analytic_turns(const Pose2& from, const Pose2& to,
                                                        const AnalyticTurnParams& params) {
  const int steps = static_cast<int>(std::floor(params.longest_lead_m / params.lead_step_m + 1e-9));
  std::vector<Candidate> candidates;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      const double out_m = i * params.lead_step_m, in_m = j * params.lead_step_m;
      const Pose2 begin = advance(from, out_m, 0.0), end = advance(to, -in_m, 0.0);
      for (const DubinsWord word : kDubinsWords) {
        const DubinsPath dubins = calc_dubins_word(begin, end, params.radius_m, word);
        if (!dubins.exists) continue;
        candidates.push_back({out_m + dubins.length_m() + in_m, out_m, in_m, dubins});
      }
    }
  }
  // A millimetre more or less is no reason to prefer one: lengths are compared in whole ones.
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    const long long left = std::llround(a.length_m * 1e3), right = std::llround(b.length_m * 1e3);
    return left != right ? left < right : a.out_m < b.out_m;
  });

  std::vector<std::vector<PathPiece>> turns;
  turns.reserve(candidates.size());
  for (const Candidate& candidate : candidates) {
    std::vector<PathPiece>& pieces = turns.emplace_back();
    const auto add_straight = [&](const Pose2& start, double length_m) {
      if (length_m < kShortest_m) return;
      pieces.push_back({start, length_m, 0.0, PathKind::kTurn, -1, params.speed_mps});
    };
    const Pose2 begin = advance(from, candidate.out_m, 0.0);
    add_straight(from, candidate.out_m);
    append_dubins(begin, candidate.dubins, PathKind::kTurn, params.speed_mps, pieces);
    add_straight(advance(to, -candidate.in_m, 0.0), candidate.in_m);
  }
  return turns;
}

double calc_length_m(const std::vector<PathPiece>& pieces) {
  return std::accumulate(pieces.begin(), pieces.end(), 0.0,
                         [](double sum, const PathPiece& piece) { return sum + piece.length_m; });
}

}  // namespace vinerow
