#pragma once
/// The mission of a ground vehicle as a sequence of sub-goals: the alleys to drive, each with its
/// entrance and exit, and the turns between them (paper A, section 4.1; reference: sub-goals at row
/// end, turn exit, row start).

#include <string>
#include <vector>

#include "controllers/parts/paths/path_pieces.h"
#include "controllers/parts/paths/pose2.h"
#include "controllers/planning/routes/alley_order.h"
#include "engine/api/forward.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

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
  double beyond_m = 0.0;  ///< legs go this far beyond the row ends before and after a turn

  /// @param alley_count  of the map  @param who  for errors, "rover.planner (coverage)"
  /// @throws ConfigError if an alley is asked that the map does not have, or asked twice
  void demand_alleys(int alley_count, const std::string& who) const;
};

/// Parameters of every planner that drives alleys: alleys, order, straighten_m.
const ParameterTable<RowRouteParams>& row_route_table();

/// Legs, each entered from the end nearer to where the one before ended, which makes directions
/// alternate; the first from the end nearer to `start_W`. The first entrance and the last exit stay
/// at the row ends whatever beyond_m is.
/// @returns a failure that names the alley, if the map has none or one has no length
Result<std::vector<RouteLeg>> make_row_route(const RowMap& map, const RowRouteParams& params,
                                             const Eigen::Vector2d& start_W);

/// The leg's straights, of kind kLeg.
void append_leg(const RouteLeg& leg, double speed_mps, std::vector<PathPiece>& pieces);

}  // namespace vinerow::controllers
