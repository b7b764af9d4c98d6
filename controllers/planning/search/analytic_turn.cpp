#include "controllers/planning/search/analytic_turn.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vinerow::controllers {

std::vector<AnalyticTurn> make_analytic_turns(const Pose2& from, const Pose2& to,
                                              const AnalyticTurnParams& params) {
  const int steps = static_cast<int>(std::floor(params.longest_lead_m / params.lead_step_m + 1e-9));
  std::vector<AnalyticTurn> turns;
  turns.reserve(static_cast<std::size_t>(steps + 1) * (steps + 1) * kDubinsWords.size());
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      const double out_m = i * params.lead_step_m, in_m = j * params.lead_step_m;
      const Pose2 begin = advance(from, out_m, 0.0), end = advance(to, -in_m, 0.0);
      for (const DubinsWord word : kDubinsWords) {
        const DubinsPath dubins = calc_dubins_word(begin, end, params.radius_m, word);
        if (!dubins.exists) continue;
        turns.push_back({out_m + dubins.length_m() + in_m, out_m, in_m, dubins});
      }
    }
  }
  std::stable_sort(turns.begin(), turns.end(), [](const auto& a, const auto& b) {
    const long long left = std::llround(a.length_m * 1e3), right = std::llround(b.length_m * 1e3);
    return left != right ? left < right : a.out_m < b.out_m;
  });
  return turns;
}

std::vector<PathSegment> make_pieces(const Pose2& from, const Pose2& to, const AnalyticTurn& turn) {
  constexpr double kShortest_m = 1e-9;
  std::vector<PathSegment> pieces;
  const auto add_straight = [&](const Pose2& start, double length_m) {
    if (length_m > kShortest_m) {
      pieces.push_back({start, length_m, 0.0, PathKind::kTurn, -1, 0.0});
    }
  };
  add_straight(from, turn.out_m);
  append_dubins(advance(from, turn.out_m, 0.0), turn.dubins, PathKind::kTurn, 0.0, pieces);
  add_straight(advance(to, -turn.in_m, 0.0), turn.in_m);
  return pieces;
}

double calc_length_m(const std::vector<PathSegment>& pieces) {
  return std::accumulate(pieces.begin(), pieces.end(), 0.0,
                         [](double sum, const PathSegment& piece) { return sum + piece.length_m; });
}

}  // namespace vinerow::controllers
