#pragma once
/// Parallel lanes of a survey over a polygon.

#include <vector>

#include "engine/math/polygon.h"

namespace vinerow::controllers {

/// Coordinates along (s) and across (t, to the left) the lanes.
struct LaneFrame {
  double yaw_rad = 0.0;  ///< of s in W

  Eigen::Vector2d along() const;
  Eigen::Vector2d across() const;
  Eigen::Vector2d to_lane(const Eigen::Vector2d& p_W) const;  ///< (s, t)
  Eigen::Vector2d to_world(double s, double t) const;
};

/// Section of a lane with the camera on, from `from_m` to `to_m` along the lane.
struct LaneSegment {
  double from_m = 0.0;
  double to_m = 0.0;
};

struct SurveyLane {
  double across_m = 0.0;            ///< t of the lane
  std::vector<LaneSegment> pieces;  ///< >= 1, ascending, apart
  double low_m() const { return pieces.front().from_m; }
  double high_m() const { return pieces.back().to_m; }
};

struct LaneNeeds {
  double spacing_m = 45.0;           ///< maximum distance between lanes
  double footprint_width_m = 133.0;  ///< of a picture, across the lanes
  double footprint_length_m = 100.0;
  double edge_margin = 0.0;  ///< distance of the outermost lanes beyond the polygon as a share of
                             ///< the footprint's width, -0.5 to 0.5
  double end_margin =
      0.5;  ///< distance of the pictures beyond the polygon as a share of the footprint's length
};

/// Direction across which the polygon is narrowest, so that it needs the fewest lanes: that of the
/// edge of its convex hull with the narrowest strip (one of the edges is always optimal; Toussaint,
/// "Solving geometric problems with the rotating calipers", 1983). In (-pi/2, pi/2].
double choose_lane_yaw_rad(const Polygon& polygon);

/// Evenly spaced lanes, ceil(width / spacing) + 1 of them if edge_margin is 0 (paper A's reference,
/// section 2). Each lane photographs all of the polygon within one spacing to either side, so that
/// every place is seen from the lanes on both of its sides. The camera is off above a notch of the
/// polygon that is longer than a picture.
/// @param polygon  cleaned, without fault
std::vector<SurveyLane> cut_lanes(const Polygon& polygon, const LaneFrame& frame,
                                  const LaneNeeds& needs);

}  // namespace vinerow::controllers
