#pragma once
/// Is there room for a vehicle along a planned route, and if not, why: refusals of the route
/// planners.

#include <optional>
#include <string>
#include <vector>

#include "controllers/parts/paths/footprint.h"
#include "controllers/planning/routes/row_route.h"

namespace vinerow::controllers {

class RouteRoom {
 public:
  /// References must outlive this. @param step_m  between poses of the swept check
  RouteRoom(const RowMap& map, const Footprint& footprint, double step_m)
      : map_(map), footprint_(footprint), step_m_(step_m) {}

  bool is_free(const std::vector<PathPiece>& pieces) const;
  /// Least clearance along the pieces, m; infinite for none.
  double clearance_m(const PathPiece& piece) const;
  /// Why a pose is not free: "(1.25, 3.00) heading 90.0 deg lies in a row: 0.10 m from the centre
  /// line of row 2, whose canopy is 0.60 m wide".
  std::string tell(const Pose2& pose) const;
  /// @returns nothing where the leg's ends are free, else which is not
  std::optional<std::string> find_blocked_end(const RouteLeg& leg) const;
  /// @returns nothing where the whole leg is free, else where it is not
  std::optional<std::string> find_blocked(const RouteLeg& leg) const;

 private:
  const RowMap& map_;
  const Footprint& footprint_;
  double step_m_;
};

}  // namespace vinerow::controllers
