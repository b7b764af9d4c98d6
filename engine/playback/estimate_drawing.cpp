#include "engine/playback/estimate_drawing.h"

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"
#include "engine/math/decomposition.h"
#include "engine/metrics/estimate_judge.h"

namespace vinerow::playback {
namespace {

using metrics::kInside95;
constexpr int kEllipsePoints = 96;
constexpr int kEarlierPoints = 48;
constexpr double kMinSpacing_m = 1.0;
constexpr double kEstimatePitch_m = 0.05;
/// Height above ground from which a marker has a plumb line.
constexpr double kMinPlumb_m = 0.3;
/// Opacity of lines behind canopy, relative to visible ones.
constexpr float kHiddenShare = 0.45f;
/// Share of the marker's strokes that is left open in the middle, to show a small ellipse there.
constexpr double kMarkerGap = 0.4;
/// Dark rim of coloured lines, which keeps them visible on soil and leaves alike.
const Eigen::Vector3f kRim{0.03f, 0.03f, 0.05f};
constexpr float kRim_px = 1.2f;
constexpr float kRimAlpha = 0.55f;

using Ground = std::function<double(double, double)>;

Eigen::Vector3d on_ground(const Eigen::Vector2d& p, const Ground& ground_m) {
  return {p.x(), p.y(), ground_m(p.x(), p.y()) + kHover_m};
}

render::Polyline line_of(const EstimateLook& look, float width_px, float alpha) {
  render::Polyline line;
  line.colour = look.colour;
  line.width_px = width_px;
  line.alpha = alpha;
  line.hidden_alpha = look.is_map ? alpha : kHiddenShare * alpha;
  return line;
}

void add_with_rim(render::Polyline line, std::vector<render::Polyline>& lines) {
  render::Polyline rim = line;
  rim.colour = kRim;
  rim.width_px += 2.0f * kRim_px;
  rim.alpha *= kRimAlpha;
  rim.hidden_alpha *= kRimAlpha;
  lines.push_back(std::move(rim));
  lines.push_back(std::move(line));
}

double longest_axis_m(const Odometry& estimate) {
  const SymmetricEigen<2> axes =
      decompose_symmetric<2>(estimate.position_covariance().topLeftCorner<2, 2>());
  return std::sqrt(kInside95 * std::max(0.0, axes.values[1]));
}

void add_earlier_ellipses(const Trace<Odometry>& trace, const Odometry& now, std::size_t end,
                          const EstimateLook& look, const Ground& ground_m,
                          std::vector<render::Polyline>& lines) {
  render::Polyline ellipses = line_of(look, 1.3f, 0.6f);
  ellipses.pairs = true;
  // Backwards from now, so that the earlier ellipses keep their distance from the current one.
  const Odometry* last = &now;
  for (std::size_t i = end + 1; i-- > 0;) {
    const Odometry& earlier = trace.values[i];
    const double apart_m = (earlier.X_WB.p - last->X_WB.p).head<2>().norm();
    if (apart_m < std::max(kMinSpacing_m, longest_axis_m(earlier) + longest_axis_m(*last)))
      continue;
    last = &earlier;
    const std::vector<Eigen::Vector2d> points = ellipse_95(earlier, kEarlierPoints);
    for (std::size_t k = 0; k < points.size(); ++k) {
      ellipses.points_W.push_back(on_ground(points[k], ground_m));
      ellipses.points_W.push_back(on_ground(points[(k + 1) % points.size()], ground_m));
    }
  }
  if (!ellipses.points_W.empty()) lines.push_back(std::move(ellipses));
}

void add_trail(const Trace<Odometry>& trace, const Odometry& now, std::size_t end,
               const EstimateLook& look, std::vector<render::Polyline>& lines) {
  render::Polyline trail = line_of(look, 1.8f, 0.9f);
  const Eigen::Vector3d below(0, 0, -look.down_m);
  for (std::size_t i = 0; i <= end; ++i) {
    const Eigen::Vector3d p = trace.values[i].X_WB * below;
    if (!trail.points_W.empty() && (trail.points_W.back() - p).norm() < kEstimatePitch_m) continue;
    trail.points_W.push_back(p);
  }
  trail.points_W.push_back(now.X_WB * below);
  lines.push_back(std::move(trail));
}

void add_marker(const Odometry& now, const EstimateLook& look, const Ground& ground_m,
                std::vector<render::Polyline>& lines) {
  const Eigen::Vector3d p = now.X_WB.p;
  const Eigen::Vector3d foot = on_ground(p.head<2>(), ground_m);
  if (!look.is_map && p.z() - foot.z() > kMinPlumb_m) {
    render::Polyline plumb = line_of(look, 1.3f, 0.7f);
    plumb.points_W = {p, foot};
    lines.push_back(std::move(plumb));
  }
  render::Polyline cross = line_of(look, 2.0f, 1.0f);
  cross.pairs = true;
  for (const Eigen::Vector3d& direction : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
                                           Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, -1, 0)}) {
    cross.points_W.push_back(now.X_WB * Eigen::Vector3d(kMarkerGap * look.marker_m * direction));
    cross.points_W.push_back(now.X_WB * Eigen::Vector3d(look.marker_m * direction));
  }
  add_with_rim(std::move(cross), lines);
}

}  // namespace

std::vector<Eigen::Vector2d> ellipse_95(const Odometry& estimate, int count) {
  const Eigen::Matrix2d P = estimate.position_covariance().topLeftCorner<2, 2>();
  if (!P.allFinite()) return {};
  const SymmetricEigen<2> axes = decompose_symmetric<2>(P);
  const Eigen::Vector2d& lambda = axes.values;
  if (!(lambda[0] >= 0.0 && lambda[1] > 0.0)) return {};
  const Eigen::Vector2d semi = (kInside95 * lambda).cwiseSqrt();
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * kPi * k / count;
    const Eigen::Vector2d along(semi[0] * std::cos(angle), semi[1] * std::sin(angle));
    points.push_back(estimate.X_WB.p.head<2>() + axes.vectors * along);
  }
  return points;
}

std::vector<render::Polyline> draw_estimate(const Trace<Odometry>& trace, Time t,
                                            const EstimateLook& look, const Ground& ground_m) {
  if (trace.empty() || trace.times.front() > t) return {};
  const Odometry now = odometry_at(trace, t);
  const std::size_t end = trace.index_at(t);
  std::vector<render::Polyline> lines;
  add_earlier_ellipses(trace, now, end, look, ground_m, lines);
  if (!look.inside) add_trail(trace, now, end, look, lines);
  const std::vector<Eigen::Vector2d> points = ellipse_95(now, kEllipsePoints);
  if (!points.empty()) {
    render::Polyline ellipse = line_of(look, 2.6f, 1.0f);
    for (std::size_t k = 0; k <= points.size(); ++k) {
      ellipse.points_W.push_back(on_ground(points[k % points.size()], ground_m));
    }
    add_with_rim(std::move(ellipse), lines);
  }
  if (!look.inside) add_marker(now, look, ground_m, lines);
  return lines;
}

}  // namespace vinerow::playback
