#include "engine/math/polyline_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace vinerow {
namespace {

using Eigen::Vector2d;

// Relative to the coordinates: far more than the rounding of a distance, so that a box never hides
// one of two equals.
constexpr double kRounding = 1e-12;

bool is_before(const PolylineIndex::Nearest& a, const PolylineIndex::Nearest& b) {
  return std::tie(a.distance_m, a.line, a.segment) < std::tie(b.distance_m, b.line, b.segment);
}

/// Rotation that turns the prevailing direction of lines to the x axis. The doubled angles of
/// segments, weighted by length, are summed up: opposite directions are the same.
Eigen::Matrix2d turn_along(const std::vector<Polyline>& lines) {
  Vector2d sum = Vector2d::Zero();
  for (const Polyline& line : lines) {
    for (std::size_t i = 0; i + 1 < line.points().size(); ++i) {
      const Vector2d d = line.points()[i + 1] - line.points()[i];
      const double length_m = d.norm();
      if (!(length_m > 0.0) || !d.allFinite()) continue;
      sum += Vector2d(d.x() * d.x() - d.y() * d.y(), 2.0 * d.x() * d.y()) / length_m;
    }
  }
  const double size = sum.norm();
  if (!(size > 0.0) || !sum.allFinite()) return Eigen::Matrix2d::Identity();
  // Half the angle: cos^2 = (1 + cos 2a) / 2, sin^2 = (1 - cos 2a) / 2.
  const double c = std::sqrt(0.5 * std::max(0.0, 1.0 + sum.x() / size));
  const double s = std::copysign(std::sqrt(0.5 * std::max(0.0, 1.0 - sum.x() / size)), sum.y());
  return (Eigen::Matrix2d() << c, s, -s, c).finished();
}

}  // namespace

PolylineIndex::PolylineIndex(std::vector<Polyline> lines)
    : lines_(std::move(lines)), from_W_(turn_along(lines_)) {
  std::vector<BoxTree<double, 2>::Box> boxes;
  for (std::size_t line = 0; line < lines_.size(); ++line) {
    const std::vector<Vector2d>& points = lines_[line].points();
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const Vector2d &from = points[i], &to = points[i + 1];
      if (!from.allFinite() || !to.allFinite() || (to - from).isZero()) continue;
      segments_.push_back({static_cast<int>(line), static_cast<int>(i)});
      const Vector2d a = from_W_ * from, b = from_W_ * to;
      boxes.emplace_back(a.cwiseMin(b), a.cwiseMax(b));
      largest_m_ = std::max({largest_m_, from.cwiseAbs().maxCoeff(), to.cwiseAbs().maxCoeff()});
    }
  }
  tree_ = BoxTree<double, 2>(boxes);
}

template <class Look>
void PolylineIndex::search(const Vector2d& p, const double& reach_m, Look&& look) const {
  if (!p.allFinite()) return;
  const double rounding_m = kRounding * (largest_m_ + p.cwiseAbs().maxCoeff());
  const auto limit2 = [&] { return (reach_m + rounding_m) * (reach_m + rounding_m); };
  double limit2_m2 = limit2();
  const Vector2d q = from_W_ * p;
  tree_.search([&](const auto& box) { return box.squaredExteriorDistance(q); }, limit2_m2,
               [&](std::uint32_t item) {
                 const Segment& segment = segments_[item];
                 Nearest found;
                 static_cast<Polyline::Nearest&>(found) =
                     lines_[segment.line].nearest_within(p, segment.number, segment.number);
                 found.line = segment.line;
                 look(found);
                 limit2_m2 = limit2();
               });
}

PolylineIndex::Nearest PolylineIndex::nearest(const Vector2d& p) const {
  Nearest best;
  search(p, best.distance_m, [&](const Nearest& found) {
    if (is_before(found, best)) best = found;
  });
  return best;
}

std::array<PolylineIndex::Nearest, 2> PolylineIndex::nearest_two(const Vector2d& p) const {
  Nearest first, second;
  search(p, second.distance_m, [&](const Nearest& found) {
    if (!is_before(found, second)) return;
    if (found.line == first.line) {
      if (is_before(found, first)) first = found;
    } else if (is_before(found, first)) {
      second = first;
      first = found;
    } else {
      second = found;
    }
  });
  return {first, second};
}

void PolylineIndex::visit_within(const Vector2d& p, double reach_m,
                                 const std::function<void(const Nearest&)>& visit) const {
  search(p, reach_m, visit);
}

}  // namespace vinerow
