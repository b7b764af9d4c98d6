#include "controllers/parts/paths/path_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {
constexpr double kShortestPiece_m = 1e-6;
constexpr double kMaxPoints = 2e6;  // 100 bytes each
}  // namespace

PathSegment make_straight(const Eigen::Vector2d& a, const Eigen::Vector2d& b, PathKind kind,
                          int alley, double speed_mps) {
  const Eigen::Vector2d ab = b - a;
  return {{a, std::atan2(ab.y(), ab.x())}, ab.norm(), 0.0, kind, alley, speed_mps};
}

void append_dubins(const Pose2& start, const DubinsPath& dubins, PathKind kind, double speed_mps,
                   std::vector<PathSegment>& pieces) {
  Pose2 pose = start;
  for (const DubinsPath::Piece& piece : dubins.pieces) {
    if (piece.length_m < kShortestPiece_m) continue;
    pieces.push_back({pose, piece.length_m, piece.curvature_per_m, kind, -1, speed_mps});
    pose = pieces.back().end();
  }
}

PlannedPath make_planned_path(const std::vector<PathSegment>& pieces, double pitch_m) {
  VINEROW_DEMAND(pitch_m > 0.0);
  double length_m = 0.0;
  for (const PathSegment& piece : pieces) length_m += piece.length_m;
  if (length_m / pitch_m > kMaxPoints) {
    throw ConfigError(fmt::format(
        "a plan of {:.4g} km with a point every {:.3g} m has {:.3g} million points, must be at "
        "most {:g} million: take a coarser waypoint_pitch_m",
        length_m / 1e3, pitch_m, length_m / pitch_m / 1e6, kMaxPoints / 1e6));
  }
  PlannedPath path;
  const auto add_point = [&path](const PathSegment& piece, const Pose2& pose) {
    PathPoint point;
    point.p_W = {pose.p.x(), pose.p.y(), 0.0};
    point.yaw_rad = wrap_angle(pose.yaw_rad);
    point.curvature_per_m = piece.curvature_per_m;
    point.speed_mps = piece.speed_mps;
    point.kind = piece.kind;
    point.alley = piece.alley;
    path.points.push_back(point);
  };
  const PathSegment* last = nullptr;
  for (const PathSegment& piece : pieces) {
    if (piece.length_m < kShortestPiece_m) continue;
    const int parts = std::max(1, static_cast<int>(std::lround(piece.length_m / pitch_m)));
    for (int i = 0; i < parts; ++i) add_point(piece, piece.at(piece.length_m * i / parts));
    path.length_m += piece.length_m;
    last = &piece;
  }
  if (last != nullptr) add_point(*last, last->end());
  return path;
}

}  // namespace vinerow::controllers
