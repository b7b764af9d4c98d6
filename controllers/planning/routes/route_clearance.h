#pragma once
/// Clearance check of planned routes, with reasons for the error messages of the route planners.

#include <optional>
#include <string>
#include <vector>

#include "controllers/parts/paths/footprint.h"
#include "controllers/planning/routes/row_route.h"

namespace vinerow::controllers {

class RouteClearance {
 public:
  /// References must outlive this. @param step_m  between poses of the collision check
  RouteClearance(const RowMap& map, const Footprint& footprint, double step_m)
      : map_(map), footprint_(footprint), step_m_(step_m) {}

  bool is_free(const std::vector<PathSegment>& pieces) const;
  /// Minimum clearance along the piece, m.
  double clearance_m(const PathSegment& piece) const;
  /// Reason why a pose is not free: "(1.25, 3.00) heading 90.0 deg is in a row: 0.10 m from the
  /// centre line of row 2, whose canopy is 0.60 m wide".
  std::string describe(const Pose2& pose) const;
  /// @returns nullopt if both ends of the leg are free, else a sentence on the blocked one
  std::optional<std::string> find_blocked_end(const RouteLeg& leg) const;
  /// @returns nullopt if the whole leg is free, else a sentence with the blocked place
  std::optional<std::string> find_blocked(const RouteLeg& leg) const;

 private:
  const RowMap& map_;
  const Footprint& footprint_;
  double step_m_;
};

}  // namespace vinerow::controllers
