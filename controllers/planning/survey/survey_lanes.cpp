#include "controllers/planning/survey/survey_lanes.h"

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/pose2.h"
#include "engine/core/constants.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;

void extend(LaneSegment& piece, double s) {
  piece.from_m = std::min(piece.from_m, s);
  piece.to_m = std::max(piece.to_m, s);
}

/// Sections along the lanes at which the polygon, in lane coordinates, has ground between two
/// values of t.
std::vector<LaneSegment> project_strip(const Polygon& polygon, double low_t, double high_t) {
  std::vector<double> levels = {low_t, high_t};
  for (const Vector2d& p : polygon) {
    if (p.y() > low_t && p.y() < high_t) levels.push_back(p.y());
  }
  std::sort(levels.begin(), levels.end());
  std::vector<LaneSegment> pieces;
  // No edge starts or ends between two levels: there the polygon consists of trapezoids.
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    const double bottom = levels[k], top = levels[k + 1], middle = 0.5 * (bottom + top);
    if (top - bottom < 1e-9) continue;
    struct Side {
      double s, at_bottom, at_top;
    };
    std::vector<Side> sides;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if ((a.y() <= middle) == (b.y() <= middle)) continue;
      const auto s_at = [&](double t) {
        const double share = std::clamp((t - a.y()) / (b.y() - a.y()), 0.0, 1.0);
        return a.x() + share * (b.x() - a.x());
      };
      sides.push_back({s_at(middle), s_at(bottom), s_at(top)});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.s < b.s; });
    for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
      LaneSegment piece{sides[i].at_bottom, sides[i].at_bottom};
      for (const double s : {sides[i].at_top, sides[i + 1].at_bottom, sides[i + 1].at_top}) {
        extend(piece, s);
      }
      pieces.push_back(piece);
    }
  }
  return pieces;
}

/// Lengthens pieces by `margin_m` at both ends and joins those with a gap of less than `gap_m`.
std::vector<LaneSegment> join_pieces(std::vector<LaneSegment> pieces, double margin_m,
                                     double gap_m) {
  std::sort(pieces.begin(), pieces.end(),
            [](const LaneSegment& a, const LaneSegment& b) { return a.from_m < b.from_m; });
  std::vector<LaneSegment> joined;
  for (LaneSegment piece : pieces) {
    piece.from_m -= margin_m;
    piece.to_m += margin_m;
    if (!joined.empty() && piece.from_m <= joined.back().to_m + gap_m) {
      joined.back().to_m = std::max(joined.back().to_m, piece.to_m);
    } else {
      joined.push_back(piece);
    }
  }
  return joined;
}

}  // namespace

Vector2d LaneFrame::along() const {
  return direction(yaw_rad);
}
Vector2d LaneFrame::across() const {
  return left_of(direction(yaw_rad));
}
Vector2d LaneFrame::to_lane(const Vector2d& p_W) const {
  return {p_W.dot(along()), p_W.dot(across())};
}
Vector2d LaneFrame::to_world(double s, double t) const {
  return s * along() + t * across();
}

double choose_lane_yaw_rad(const Polygon& polygon) {
  const Polygon hull = convex_hull(polygon);
  double best_yaw_rad = 0.0, best_width_m = kInfinity;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d edge = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    double width_m = 0.0;
    for (const Vector2d& p : hull) width_m = std::max(width_m, cross(edge, p - hull[i]));
    // Among equals the first, independent of rounding.
    if (width_m >= best_width_m - 1e-6) continue;
    best_width_m = width_m;
    best_yaw_rad = std::atan2(edge.y(), edge.x());
  }
  if (best_yaw_rad > 0.5 * kPi) best_yaw_rad -= kPi;
  if (best_yaw_rad <= -0.5 * kPi) best_yaw_rad += kPi;
  return best_yaw_rad;
}

std::vector<SurveyLane> cut_lanes(const Polygon& polygon, const LaneFrame& frame,
                                  const LaneNeeds& needs) {
  Polygon turned;
  double low_t = kInfinity, high_t = -kInfinity;
  for (const Vector2d& p : polygon) {
    turned.push_back(frame.to_lane(p));
    low_t = std::min(low_t, turned.back().y());
    high_t = std::max(high_t, turned.back().y());
  }
  const double beyond_m = needs.edge_margin * needs.footprint_width_m;
  const double span_m = high_t - low_t + 2.0 * beyond_m;
  int count = 1;
  double first_t = 0.5 * (low_t + high_t), spacing_m = needs.spacing_m;
  if (span_m > 0.0) {
    count = static_cast<int>(std::ceil(span_m / needs.spacing_m - 1e-9)) + 1;
    spacing_m = span_m / (count - 1);
    first_t = low_t - beyond_m;
  }
  // A single lane has to cover the whole width.
  const double half_width_m = 0.5 * needs.footprint_width_m;
  const double reach_m =
      (count == 1 ? half_width_m : std::min(std::max(spacing_m, beyond_m), half_width_m)) + 1e-6;
  std::vector<SurveyLane> lanes;
  for (int i = 0; i < count; ++i) {
    SurveyLane lane;
    lane.across_m = first_t + i * spacing_m;
    lane.pieces =
        join_pieces(project_strip(turned, lane.across_m - reach_m, lane.across_m + reach_m),
                    needs.end_margin * needs.footprint_length_m, needs.footprint_length_m);
    if (!lane.pieces.empty()) lanes.push_back(lane);
  }
  return lanes;
}

}  // namespace vinerow::controllers
