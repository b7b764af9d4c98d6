#include "controllers/trajectory/smooth_run.h"

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/box_filter.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kStep_m = 0.05;
constexpr int kFewestPieces = 4;

}  // namespace

SmoothRun::SmoothRun(const CurveRun& run, double blend_m) : is_vertical_(run.is_vertical) {
  const int pieces = std::max(kFewestPieces, static_cast<int>(std::lround(run.length_m / kStep_m)));
  const double step_m = run.length_m / pieces;
  std::vector<Eigen::Vector3d> points;
  points.reserve(pieces + 1);
  std::size_t piece = 0;
  double piece_start_m = 0.0;
  for (int i = 0; i <= pieces; ++i) {
    const double at_m = i * step_m;
    while (piece + 1 < run.pieces.size() && at_m >= piece_start_m + run.pieces[piece].length_m) {
      piece_start_m += run.pieces[piece].length_m;
      ++piece;
    }
    const CurveSegment& on = run.pieces[piece];
    points.push_back(on.at(std::min(at_m - piece_start_m, on.length_m)));
    kinds_.push_back(on.kind);
    speeds_mps_.push_back(on.speed_mps);
  }
  if (!is_vertical_) {
    for (const double width_m : {blend_m, 0.5 * blend_m}) {
      points = smooth_box(points, calc_half_window(width_m, step_m), Beyond::kTurnedAbout);
    }
  }
  spline_ = UniformSpline<Eigen::Vector3d>(step_m, points);
  yaw_rad_.assign(pieces + 1, 0.0);
  if (is_vertical_) return;
  for (int i = 0; i <= pieces; ++i) {
    const Eigen::Vector3d along = spline_.at(i * step_m).first;
    const double yaw_rad = std::atan2(along.y(), along.x());
    yaw_rad_[i] = i == 0 ? yaw_rad : yaw_rad_[i - 1] + wrap_angle(yaw_rad - yaw_rad_[i - 1]);
  }
}

SmoothRun::Sample SmoothRun::at(double at_m) const {
  const auto on = spline_.at(at_m);
  Sample sample{on.value, on.first, on.second, 0.0, 0.0};
  if (is_vertical_) return sample;
  const Eigen::Vector2d d = on.first.head<2>(), dd = on.second.head<2>();
  const double near_rad = yaw_rad_[spline_.piece_at(at_m)];
  sample.yaw_rad = near_rad + wrap_angle(std::atan2(d.y(), d.x()) - near_rad);
  sample.yaw_per_m = cross(d, dd) / d.squaredNorm();
  return sample;
}

}  // namespace vinerow::controllers
