#pragma once
/// Stretches of a plan and the shared alleys that each of them needs.
///
/// Distances along a plan are those that followers report: arc length in the plane, along arcs
/// between points that have a curvature; for flying vehicles, arc length in space.

#include <vector>

#include "engine/api/forward.h"
#include "engine/api/plant_row.h"

namespace vinerow {

/// A stretch of a plan that may be entered only with all these alleys.
struct AlleyStretch {
  double start_m = 0.0;
  double end_m = 0.0;
  std::vector<int> needs;  ///< indices into the list of alleys, ascending, not empty
};

/// How a vehicle uses the alleys.
struct AlleyUse {
  /// The vehicle climbs, descends, returns and approaches the rows above them. These parts of its
  /// plan need no alley, except for the last approach_m before the rows.
  bool flies = false;
  /// Length of the path to the first alley, and of a ground vehicle's path from the last one, that
  /// needs that alley too, so that nobody waits where others turn.
  double approach_m = 4.0;
  /// Distance beyond an alley's end within which a crossing path counts as passing its mouth.
  double headland_m = 8.0;
};

/// Arc length from the start of a plan to each of its points, m. @param flies  measures in space
std::vector<double> measure_plan(const PlannedPath& plan, bool flies);

/// Finds the stretches of a plan that need alleys. A leg needs the alley whose centre line is
/// nearest to its middle, if that is not farther away than the alley's width. The alley numbers of
/// the plan are not used, because they may belong to another map. The path between two legs needs
/// the alleys of both, and every alley whose mouth it passes.
/// @returns stretches in order, not overlapping; without those that need no alley
std::vector<AlleyStretch> find_alley_stretches(const PlannedPath& plan,
                                               const std::vector<Alley>& alleys,
                                               const AlleyUse& use);

}  // namespace vinerow
