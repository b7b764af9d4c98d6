#include "engine/math/polygon.h"

#include <algorithm>
#include <tuple>

namespace vinerow {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Positive: c is left of the way from a to b.
double side(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return cross(b - a, c - a);
}

/// c lies within the box around a and b. @pre on their line
bool between(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (c.array() >= a.cwiseMin(b).array()).all() && (c.array() <= a.cwiseMax(b).array()).all();
}

bool meet(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const double a_side = side(c, d, a), b_side = side(c, d, b);
  const double c_side = side(a, b, c), d_side = side(a, b, d);
  if (a_side * b_side < 0.0 && c_side * d_side < 0.0) return true;
  return (a_side == 0.0 && between(c, d, a)) || (b_side == 0.0 && between(c, d, b)) ||
         (c_side == 0.0 && between(a, b, c)) || (d_side == 0.0 && between(a, b, d));
}

}  // namespace

double signed_area_m2(const Polygon& polygon) {
  double twice = 0.0;
  // About the first corner: far from the origin the products would lose digits.
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += side(polygon[0], polygon[i - 1], polygon[i]);
  }
  return 0.5 * twice;
}

bool contains(const Polygon& polygon, const Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.y() <= p.y()) == (b.y() <= p.y())) continue;
    if (a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > p.x()) inside = !inside;
  }
  return inside;
}

Polygon convex_hull(Polygon points) {
  const auto order = [](const Vector2d& a, const Vector2d& b) {
    return std::tie(a.x(), a.y()) < std::tie(b.x(), b.y());
  };
  std::sort(points.begin(), points.end(), order);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  Polygon hull;
  const auto add = [&hull](const Vector2d& p, std::size_t keep) {
    while (hull.size() > keep && side(hull[hull.size() - 2], hull.back(), p) <= 0.0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Vector2d& p : points) add(p, 1);  // lower chain
  const std::size_t lower = hull.size();
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
  hull.pop_back();  // the first corner again
  return hull;
}

Polygon clip(const Polygon& subject, const Polygon& convex) {
  Polygon rest = subject, next;
  for (std::size_t i = 0; i < convex.size() && !rest.empty(); ++i) {
    const Vector2d &from = convex[i], &to = convex[(i + 1) % convex.size()];
    next.clear();
    for (std::size_t k = 0; k < rest.size(); ++k) {
      const Vector2d &a = rest[k], &b = rest[(k + 1) % rest.size()];
      const double a_side = side(from, to, a), b_side = side(from, to, b);
      if (a_side >= 0.0) next.push_back(a);
      if ((a_side > 0.0 && b_side < 0.0) || (a_side < 0.0 && b_side > 0.0)) {
        next.emplace_back(a + a_side / (a_side - b_side) * (b - a));
      }
    }
    rest.swap(next);
  }
  return rest;
}

std::optional<std::pair<int, int>> find_crossing(const Polygon& polygon) {
  const int count = static_cast<int>(polygon.size());
  for (int i = 0; i < count; ++i) {
    for (int k = i + 1; k < count; ++k) {
      const Vector2d &a = polygon[i], &b = polygon[(i + 1) % count];
      const Vector2d &c = polygon[k], &d = polygon[(k + 1) % count];
      const bool follows = k == i + 1, precedes = i == 0 && k == count - 1;
      if (!follows && !precedes) {
        if (meet(a, b, c, d)) return std::pair{i, k};
        continue;
      }
      // Neighbours share a corner; they cross only where one runs back along the other.
      const Vector2d &apex = follows ? b : a, &one = follows ? a : b, &other = follows ? d : c;
      if (side(apex, one, other) == 0.0 && (one - apex).dot(other - apex) >= 0.0) {
        return std::pair{i, k};
      }
    }
  }
  return std::nullopt;
}

}  // namespace vinerow
