#include "controllers/planning/routes/alley_order.h"

#include <algorithm>

namespace vinerow::controllers {
namespace {

double distance_to_line(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                        const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double length = ab.norm();
  return length > 0.0 ? std::abs(cross(ab, p - a)) / length : (p - a).norm();
}

void keep_farthest(const std::vector<Eigen::Vector2d>& line, std::size_t first, std::size_t last,
                   double tolerance_m, std::vector<bool>& keep) {
  double farthest_m = tolerance_m;
  std::size_t farthest = first;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double distance = distance_to_line(line[i], line[first], line[last]);
    if (distance > farthest_m) {
      farthest_m = distance;
      farthest = i;
    }
  }
  if (farthest == first) return;
  keep[farthest] = true;
  keep_farthest(line, first, farthest, tolerance_m, keep);
  keep_farthest(line, farthest, last, tolerance_m, keep);
}

}  // namespace

std::vector<int> make_alley_order(int count, AlleyOrder order) {
  std::vector<int> places;
  if (order == AlleyOrder::kSerpentine) {
    for (int i = 0; i < count; ++i) places.push_back(i);
    return places;
  }
  for (int i = 0; i < count; i += 2) places.push_back(i);
  const int last_even = places.empty() ? 0 : places.back();
  // Back over the odd alleys from the first one that is not a neighbour, then the remaining ones.
  const int first_odd = last_even - 3;
  for (int i = first_odd; i >= 1; i -= 2) places.push_back(i);
  for (int i = std::max(first_odd + 2, 1); i < count; i += 2) places.push_back(i);
  return places;
}

std::vector<Eigen::Vector2d> simplify_line(const std::vector<Eigen::Vector3d>& line_W,
                                           double tolerance_m) {
  std::vector<Eigen::Vector2d> line;
  for (const Eigen::Vector3d& p : line_W) {
    if (line.empty() || (p.head<2>() - line.back()).norm() > 1e-9) line.push_back(p.head<2>());
  }
  if (line.size() < 3) return line;
  std::vector<bool> keep(line.size(), false);
  keep.front() = keep.back() = true;
  keep_farthest(line, 0, line.size() - 1, tolerance_m, keep);
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (keep[i]) kept.push_back(line[i]);
  }
  return kept;
}

}  // namespace vinerow::controllers
