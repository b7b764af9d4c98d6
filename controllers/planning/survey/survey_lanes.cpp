#include "controllers/planning/survey/survey_lanes.h"

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/pose2.h"
#include "engine/core/constants.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;

/// Counter-clockwise (Andrew's monotone chain).
Polygon2 make_hull(Polygon2 points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  Polygon2 hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = hull.size();
    for (const Vector2d& p : points) {
      while (hull.size() >= begin + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

void extend(LanePiece& piece, double s) {
  piece.from_m = std::min(piece.from_m, s);
  piece.to_m = std::max(piece.to_m, s);
}

/// Where along the lanes the polygon, in lane coordinates, has ground between two values of t.
std::vector<LanePiece> project_strip(const Polygon2& polygon, double low_t, double high_t) {
  std::vector<double> levels = {low_t, high_t};
  for (const Vector2d& p : polygon) {
    if (p.y() > low_t && p.y() < high_t) levels.push_back(p.y());
  }
  std::sort(levels.begin(), levels.end());
  std::vector<LanePiece> pieces;
  // Between two levels no edge begins or ends: the polygon is a row of trapezoids there.
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
      LanePiece piece{sides[i].at_bottom, sides[i].at_bottom};
      for (const double s : {sides[i].at_top, sides[i + 1].at_bottom, sides[i + 1].at_top}) {
        extend(piece, s);
      }
      pieces.push_back(piece);
    }
  }
  return pieces;
}

/// Longer by `margin_m` at both ends; pieces that are then nearer than `gap_m` become one.
std::vector<LanePiece> join_pieces(std::vector<LanePiece> pieces, double margin_m, double gap_m) {
  std::sort(pieces.begin(), pieces.end(),
            [](const LanePiece& a, const LanePiece& b) { return a.from_m < b.from_m; });
  std::vector<LanePiece> joined;
  for (LanePiece piece : pieces) {
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

double choose_lane_yaw_rad(const Polygon2& polygon) {
  const Polygon2 hull = make_hull(polygon);
  double best_yaw_rad = 0.0, best_width_m = kInfinity;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d edge = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    double width_m = 0.0;
    for (const Vector2d& p : hull) width_m = std::max(width_m, cross(edge, p - hull[i]));
    // Of equals the first, whatever the last bits of the others are.
    if (width_m >= best_width_m - 1e-6) continue;
    best_width_m = width_m;
    best_yaw_rad = std::atan2(edge.y(), edge.x());
  }
  if (best_yaw_rad > 0.5 * kPi) best_yaw_rad -= kPi;
  if (best_yaw_rad <= -0.5 * kPi) best_yaw_rad += kPi;
  return best_yaw_rad;
}

std::vector<SurveyLane> cut_lanes(const Polygon2& polygon, const LaneFrame& frame,
                                  const LaneNeeds& needs) {
  Polygon2 turned;
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
  // One lane alone has to see the whole width.
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
