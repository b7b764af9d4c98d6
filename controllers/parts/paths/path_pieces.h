#pragma once
/// Path of straights and arcs, and its waypoints at a given pitch.

#include <vector>

#include "controllers/parts/paths/dubins.h"
#include "engine/api/messages/path.h"

namespace vinerow::controllers {

/// A straight or an arc.
struct PathSegment {
  Pose2 start;
  double length_m = 0.0;
  double curvature_per_m = 0.0;  ///< positive to the left, 0 = straight
  PathKind kind = PathKind::kLeg;
  int alley = -1;
  double speed_mps = 0.0;  ///< 0 = the follower's own

  Pose2 at(double distance_m) const {
    return advance(start, distance_m, distance_m * curvature_per_m);
  }
  Pose2 end() const { return at(length_m); }
};
using PathSegments = std::vector<PathSegment>;

/// The straight from `a` to `b`. @pre a != b
PathSegment make_straight(const Eigen::Vector2d& a, const Eigen::Vector2d& b, PathKind kind,
                          int alley, double speed_mps);

/// Appends the segments of a Dubins path that have a length.
void append_dubins(const Pose2& start, const DubinsPath& dubins, PathKind kind, double speed_mps,
                   std::vector<PathSegment>& pieces);

/// Waypoints: each segment is split into round(length / pitch) equal parts, at least one, so that
/// its ends are waypoints (paper B: waypoint pitch WPP). Heights are zero. Segments shorter than a
/// micrometre are left out.
/// @param pitch_m  > 0
/// @throws ConfigError if there are more than 2 million waypoints
PlannedPath make_planned_path(const std::vector<PathSegment>& pieces, double pitch_m);

}  // namespace vinerow::controllers
