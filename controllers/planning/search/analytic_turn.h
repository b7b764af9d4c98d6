#pragma once
/// Turns in closed form: Dubins paths with straights before and after.

#include <vector>

#include "controllers/parts/paths/path_pieces.h"

namespace vinerow::controllers {

/// Candidates: every Dubins word between the first pose moved forward by one straight and the
/// second moved back by another, for all pairs of straights 0, step, 2 step .. longest. Paper B
/// calls the straights headland and uses one length for both. Here each end has its own, which
/// slanted row ends need.
struct AnalyticTurnParams {
  double radius_m = 1.0;
  double longest_lead_m = 6.0;
  double lead_step_m = 0.25;
};

struct AnalyticTurn {
  double length_m = 0.0;  ///< straights included
  double out_m = 0.0;     ///< straight after `from`
  double in_m = 0.0;      ///< straight before `to`
  DubinsPath dubins;
};

/// All turns that exist, shortest first; within a millimetre, the one with the shorter straight out
/// first.
std::vector<AnalyticTurn> make_analytic_turns(const Pose2& from, const Pose2& to,
                                              const AnalyticTurnParams& params);

/// Straights and arcs of kind kTurn from `from` to `to`.
std::vector<PathSegment> make_pieces(const Pose2& from, const Pose2& to, const AnalyticTurn& turn);

double calc_length_m(const std::vector<PathSegment>& pieces);

}  // namespace vinerow::controllers
