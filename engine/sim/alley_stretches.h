#pragma once
/// Which shared alleys a plan needs, and from where to where.
///
/// Distances along a plan are those that followers tell: arcs where its points tell a curvature,
/// seen from above; of what flies in space.

#include <vector>

#include "engine/api/forward.h"
#include "engine/api/plant_row.h"

namespace vinerow {

/// A stretch of a plan that may be entered only with all these alleys.
struct AlleyStretch {
  double begin_m = 0.0;
  double end_m = 0.0;
  std::vector<int> needs;  ///< indices into the list of alleys, rising, not empty
};

struct AlleyUse {
  /// Ways up, down, home and to the rows are not on the ground and need nothing, but for approach_m
  /// before the rows.
  bool flies = false;
  /// So much of the way to the first alley, and of a ground vehicle's way from the last, needs that
  /// alley too: who waits shall not stand where others turn.
  double approach_m = 4.0;
  /// How far beyond an alley's end a way that crosses its direction passes its mouth.
  double headland_m = 8.0;
};

/// Distance of every point of a plan along it, m. @param flies  in space
std::vector<double> measure_plan(const PlannedPath& plan, bool flies);

/// Legs need the alley whose centre line is nearest to their middle, if it is not farther than its
/// width: the plan's own numbers count in a map that may be another one. What leads from leg to leg
/// needs both, and every alley whose mouth it passes. Stretches that need nothing are left out.
/// @returns in order, not overlapping
std::vector<AlleyStretch> find_alley_stretches(const PlannedPath& plan,
                                               const std::vector<Alley>& alleys,
                                               const AlleyUse& use);

}  // namespace vinerow
