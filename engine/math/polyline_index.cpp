#include "engine/math/polyline_index.h"

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

}  // namespace

PolylineIndex::PolylineIndex(std::vector<Polyline> lines) : lines_(std::move(lines)) {
  std::vector<BoxTree<double, 2>::Box> boxes;
  for (std::size_t line = 0; line < lines_.size(); ++line) {
    const std::vector<Vector2d>& points = lines_[line].points();
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const Vector2d &from = points[i], &to = points[i + 1];
      if (!from.allFinite() || !to.allFinite() || (to - from).isZero()) continue;
      segments_.push_back({static_cast<int>(line), static_cast<int>(i)});
      boxes.emplace_back(from.cwiseMin(to), from.cwiseMax(to));
      largest_m_ = std::max({largest_m_, from.cwiseAbs().maxCoeff(), to.cwiseAbs().maxCoeff()});
    }
  }
  tree_ = BoxTree<double, 2>(boxes);
}

template <class Look>
void PolylineIndex::search(const Vector2d& p, const double& reach_m, Look&& look) const {
  if (!p.allFinite()) return;
  const double rounding_m = kRounding * (largest_m_ + p.cwiseAbs().maxCoeff());
  double limit2_m2 = std::numeric_limits<double>::infinity();
  tree_.search([&](const auto& box) { return box.squaredExteriorDistance(p); }, limit2_m2,
               [&](std::uint32_t item) {
                 const Segment& segment = segments_[item];
                 Nearest found;
                 static_cast<Polyline::Nearest&>(found) =
                     lines_[segment.line].nearest_within(p, segment.number, segment.number);
                 found.line = segment.line;
                 look(found);
                 limit2_m2 = (reach_m + rounding_m) * (reach_m + rounding_m);
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

}  // namespace vinerow
