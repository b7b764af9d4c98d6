#pragma once
/// The mission of a ground vehicle as a sequence of sub-goals: the alleys to drive, each with its
/// entrance and exit, and the turns between them (paper A, section 4.1; reference: sub-goals at row
/// end, turn exit, row start).

#include <vector>

#include "controllers/parts/pose2.h"
#include "controllers/planning/alley_order.h"
#include "engine/core/result.h"

namespace vinerow {

/// An alley as it will be driven.
struct RouteLeg {
  int alley = -1;
  std::vector<Eigen::Vector2d> line_W;  ///< >= 2 vertices in driving order
  Pose2 entry() const;                  ///< first vertex, heading into the alley
  Pose2 exit() const;                   ///< last vertex, heading out
};

struct RowRouteParams {
  std::vector<int> alleys;  ///< in this order; empty = all of the map
  AlleyOrder order = AlleyOrder::kSerpentine;
  double straighten_m = 0.02;
  double beyond_m = 0.0;  ///< legs go this far beyond the row ends before a turn begins
};

/// Legs in alternating direction; the first is entered from the end nearer to `start_W`.
/// @returns a failure that names the alley, if the map has none or an index is unknown
Result<std::vector<RouteLeg>> make_row_route(const RowMap& map, const RowRouteParams& params,
                                             const Eigen::Vector2d& start_W);

}  // namespace vinerow
