#include "controllers/planning/search/path_cost.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {

PathCost::PathCost(const PathCostParams& params, const Footprint& footprint)
    : params_(params), field_(footprint.field()) {
  const std::vector<Eigen::Vector2d>& outline = footprint.outline_B();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    looked_at_B_.push_back(outline[i]);
    looked_at_B_.push_back(0.5 * (outline[i] + outline[(i + 1) % outline.size()]));
  }
}

double PathCost::rough_clearance_m(const Pose2& pose) const {
  const Eigen::Vector2d ahead = direction(pose.yaw_rad), left = left_of(ahead);
  double min_m = params_.wanted_clearance_m;
  for (const Eigen::Vector2d& p_B : looked_at_B_) {
    min_m = std::min(min_m, field_.at(pose.p + p_B.x() * ahead + p_B.y() * left));
  }
  return min_m;
}

double PathCost::of_arc(const Pose2& start, double length_m, double curvature_per_m) const {
  if (params_.clearance_weight <= 0.0 || length_m <= 0.0) return length_m;
  const int parts = std::max(1, static_cast<int>(std::ceil(length_m / params_.step_m)));
  double lacking = 0.0;  // mean missing share of the wanted clearance
  for (int i = 0; i < parts; ++i) {
    const double s = length_m * (i + 0.5) / parts;
    const double clearance_m = rough_clearance_m(advance(start, s, s * curvature_per_m));
    lacking += (1.0 - clearance_m / params_.wanted_clearance_m) / parts;
  }
  return length_m * (1.0 + params_.clearance_weight * lacking);
}

double PathCost::of(const PathSegment& piece) const {
  return of_arc(piece.start, piece.length_m, piece.curvature_per_m);
}

double PathCost::of(const std::vector<PathSegment>& pieces) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    sum += of(pieces[i]);
    const bool is_bend = i > 0 && pieces[i].curvature_per_m != pieces[i - 1].curvature_per_m;
    if (is_bend) sum += params_.bend_m;
  }
  return sum;
}

double PathCost::of(const Pose2& start, const DubinsPath& path) const {
  constexpr double kShortest_m = 1e-6;  // as append_dubins
  double sum = -params_.bend_m;         // the first piece is no change of curvature
  Pose2 pose = start;
  for (const DubinsPath::Piece& piece : path.pieces) {
    if (piece.length_m < kShortest_m) continue;
    sum += of_arc(pose, piece.length_m, piece.curvature_per_m) + params_.bend_m;
    pose = advance(pose, piece.length_m, piece.length_m * piece.curvature_per_m);
  }
  return std::max(sum, 0.0);
}

}  // namespace vinerow::controllers
