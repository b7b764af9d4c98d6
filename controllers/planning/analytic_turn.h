#pragma once
/// Turns in closed form: Dubins paths with straights before and after.

#include <functional>
#include <vector>

#include "controllers/parts/path_pieces.h"

namespace vinerow {

/// What is tried: every Dubins word between the poses moved on by `out` and back by `in`, for all
/// pairs of straights 0, step, 2 step .. longest (paper B calls them headland; here both ends have
/// their own, so that rows that end at a slant are served).
struct AnalyticTurnParams {
  double radius_m = 1.0;
  double longest_lead_m = 6.0;
  double lead_step_m = 0.5;
  double speed_mps = 0.0;
};

/// All candidates, shortest first; of equals the one with shorter straight out. Straights and arcs
/// of kind kTurn from `from` to `to`.
std::vector<std::vector<PathPiece>> make_analytic_turns(const Pose2& from, const Pose2& to,
                                                        const AnalyticTurnParams& params);

double calc_length_m(const std::vector<PathPiece>& pieces);

}  // namespace vinerow
