#pragma once
/// Route of a ground vehicle as a sequence of sub-goals: the alleys to drive, each with its
/// entrance and exit, with turns between them (paper A, section 4.1; reference: sub-goals at row
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

/// An alley in driving direction.
struct RouteLeg {
  int alley = -1;
  std::vector<Eigen::Vector2d> line_W;  ///< >= 2 vertices in driving order
  Pose2 entry() const;                  ///< first vertex, heading into the alley
  Pose2 exit() const;                   ///< last vertex, heading out
};

struct RowRouteParams {
  std::vector<int> alleys;  ///< in this order; empty: all of the map
  AlleyOrder order = AlleyOrder::kSerpentine;
  double straighten_m = 0.02;
  double beyond_m = 0.0;  ///< length of legs beyond the row ends before and after a turn

  /// @param alley_count  of the map  @param who  for errors, "rover.planner (coverage)"
  /// @throws ConfigError if an alley is listed that the map does not have, or listed twice
  void demand_alleys(int alley_count, const std::string& who) const;
};

/// Common parameters of planners that drive alleys: alleys, order, straighten_m.
const ParameterTable<RowRouteParams>& row_route_table();

/// Legs in order. Each starts at the end nearer to the end of the leg before, so that directions
/// alternate; the first starts at the end nearer to `start_W`. The first entrance and the last exit
/// stay at the row ends, whatever beyond_m is. @returns a failure that names the alley, if the map
/// has no alleys or one has no length
Result<std::vector<RouteLeg>> make_row_route(const RowMap& map, const RowRouteParams& params,
                                             const Eigen::Vector2d& start_W);

/// The leg's straights, of kind kLeg.
void append_leg(const RouteLeg& leg, double speed_mps, std::vector<PathSegment>& pieces);

}  // namespace vinerow::controllers
