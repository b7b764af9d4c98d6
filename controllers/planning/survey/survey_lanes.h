#pragma once
/// Parallel lanes over a polygon.

#include <vector>

#include "controllers/planning/survey/survey_area.h"

namespace vinerow::controllers {

/// Coordinates along (s) and across (t, to the left) the lanes.
struct LaneFrame {
  double yaw_rad = 0.0;  ///< of s in W

  Eigen::Vector2d along() const;
  Eigen::Vector2d across() const;
  Eigen::Vector2d to_lane(const Eigen::Vector2d& p_W) const;  ///< (s, t)
  Eigen::Vector2d to_world(double s, double t) const;
};

/// Camera on from `from_m` to `to_m`, along the lane.
struct LanePiece {
  double from_m = 0.0;
  double to_m = 0.0;
};

struct SurveyLane {
  double across_m = 0.0;          ///< t of the lane
  std::vector<LanePiece> pieces;  ///< >= 1, ascending, apart
  double low_m() const { return pieces.front().from_m; }
  double high_m() const { return pieces.back().to_m; }
};

struct LaneNeeds {
  double spacing_m = 45.0;           ///< at most
  double footprint_width_m = 133.0;  ///< of a picture, across the lanes
  double footprint_length_m = 100.0;
  double edge_margin = 0.0;  ///< outermost lanes this share of the footprint's width beyond the
                             ///< polygon, -0.5 to 0.5
  double end_margin = 0.5;   ///< pictures go on beyond the polygon by this share of the footprint's
                             ///< length
};

/// The direction in which the polygon is least wide, so that it takes the fewest lanes: that of the
/// edge of its convex hull with the narrowest strip (one of them always is the best; Toussaint,
/// "Solving geometric problems with the rotating calipers", 1983). In (-pi/2, pi/2].
double choose_lane_yaw_rad(const Polygon2& polygon);

/// Even lanes, ceil(width / spacing) + 1 of them where edge_margin is 0 (paper A's reference,
/// section 2). Each photographs all of the polygon that lies within one spacing beside it, so that
/// every place is seen from the lanes on both its sides; where the polygon has a notch that is
/// longer than a picture, the camera is off above it.
/// @param polygon  cleaned, without fault
std::vector<SurveyLane> cut_lanes(const Polygon2& polygon, const LaneFrame& frame,
                                  const LaneNeeds& needs);

}  // namespace vinerow::controllers
