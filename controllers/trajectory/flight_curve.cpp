#include "controllers/trajectory/flight_curve.h"

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kShortest_m = 1e-6;
// A longer chord, as a share of the diameter, does not fit the stated arc.
constexpr double kLargestChordShare = 0.999;
// Steeper segments count as vertical; a path over the ground is hardly this steep.
constexpr double kSteep = 3.0;

CurveSegment make_piece(const PathPoint& from, const PathPoint& to) {
  CurveSegment piece;
  const Eigen::Vector2d chord = (to.p_W - from.p_W).head<2>();
  const double chord_m = chord.norm();
  piece.rise_m = to.p_W.z() - from.p_W.z();
  piece.start = {from.p_W.head<2>(), from.yaw_rad};
  piece.start_height_m = from.p_W.z();
  piece.speed_mps = from.speed_mps;
  piece.kind = from.kind;
  if (chord_m > kShortest_m) {
    double half = 0.5 * from.curvature_per_m * chord_m;
    if (std::abs(half) > kLargestChordShare) half = 0.0;
    piece.curvature_per_m = half == 0.0 ? 0.0 : from.curvature_per_m;
    half = std::asin(half);
    piece.plan_length_m = std::abs(half) < 1e-8 ? chord_m : 2.0 * half / piece.curvature_per_m;
    piece.start.yaw_rad = std::atan2(chord.y(), chord.x()) - half;
  }
  piece.length_m = std::hypot(piece.plan_length_m, piece.rise_m);
  return piece;
}

bool is_joint_smooth(const CurveSegment& a, const CurveSegment& b, double sharp_rad) {
  if (a.is_vertical() != b.is_vertical()) return false;
  if (a.is_vertical()) return (a.rise_m > 0.0) == (b.rise_m > 0.0);
  return std::abs(wrap_angle(b.start.yaw_rad - a.end_yaw_rad())) <= sharp_rad;
}

}  // namespace

bool CurveSegment::is_vertical() const {
  return std::abs(rise_m) > kSteep * plan_length_m;
}

Eigen::Vector3d CurveSegment::at(double at_m) const {
  const double share = length_m > 0.0 ? at_m / length_m : 0.0;
  const double along_m = share * plan_length_m;
  const Pose2 pose = advance(start, along_m, along_m * curvature_per_m);
  return {pose.p.x(), pose.p.y(), start_height_m + share * rise_m};
}

std::vector<CurveRun> make_curve_runs(const PlannedPath& plan, double sharp_rad) {
  std::vector<CurveRun> runs;
  const PathPoint* from = nullptr;
  for (const PathPoint& to : plan.points) {
    if (from == nullptr) {
      from = &to;
      continue;
    }
    if ((to.p_W - from->p_W).norm() < kShortest_m) {
      from = &to;  // the same place, but the stretch from here may be of another kind
      continue;
    }
    const CurveSegment piece = make_piece(*from, to);
    if (runs.empty() || !is_joint_smooth(runs.back().pieces.back(), piece, sharp_rad)) {
      runs.push_back({{}, piece.is_vertical(), 0.0});
    }
    runs.back().pieces.push_back(piece);
    runs.back().length_m += piece.length_m;
    from = &to;
  }
  return runs;
}

}  // namespace vinerow::controllers
