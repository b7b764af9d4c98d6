#include "engine/math/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "engine/math/planar.h"
#include "engine/math/polyline.h"

namespace vinerow {
namespace {

using Eigen::Vector2d;

/// Positive if c is left of the line from a to b; twice the area of the triangle a, b, c.
double side(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return cross(b - a, c - a);
}

/// True if c is on the segment from a to b. @pre it is on their line
bool between(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (c - a).dot(c - b) <= 0.0;
}

/// Sign of side(); 0 within rounding.
int sign_of_side(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  constexpr double kRounding = 1e-12;  // relative to the lengths; a unit in the last place is 2e-16
  const double area = side(a, b, c), slack = kRounding * (b - a).norm() * (c - a).norm();
  return area > slack ? 1 : area < -slack ? -1 : 0;
}

bool meet(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const int a_side = sign_of_side(c, d, a), b_side = sign_of_side(c, d, b);
  const int c_side = sign_of_side(a, b, c), d_side = sign_of_side(a, b, d);
  if (a_side * b_side < 0 && c_side * d_side < 0) return true;
  return (a_side == 0 && between(c, d, a)) || (b_side == 0 && between(c, d, b)) ||
         (c_side == 0 && between(a, b, c)) || (d_side == 0 && between(a, b, d));
}

/// Part of a polygon to the left of the line through p along d.
void keep_left(const Polygon& polygon, const Vector2d& p, const Vector2d& d, Polygon& left) {
  left.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double a_side = cross(d, a - p), b_side = cross(d, b - p);
    if (a_side >= 0.0) left.push_back(a);
    if ((a_side > 0.0 && b_side < 0.0) || (a_side < 0.0 && b_side > 0.0)) {
      left.emplace_back(a + a_side / (a_side - b_side) * (b - a));
    }
  }
}

}  // namespace

double signed_area_m2(const Polygon& polygon) {
  double twice = 0.0;
  // Relative to the first corner: far from the origin the products would lose digits.
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

double distance_m(const Polygon& polygon, const Vector2d& p) {
  if (contains(polygon, p)) return 0.0;
  double away_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    away_m = std::min(away_m,
                      distance_to_segment_m<2>(p, polygon[i], polygon[(i + 1) % polygon.size()]));
  }
  return away_m;
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
    keep_left(rest, convex[i], convex[(i + 1) % convex.size()] - convex[i], next);
    rest.swap(next);
  }
  return rest;
}

Polygon cut(const Polygon& convex, const Vector2d& p, const Vector2d& d) {
  Polygon part;
  keep_left(convex, p, d, part);
  return part.size() < 3 ? Polygon{} : part;
}

Vector2d clip_line(const Polygon& convex, const Vector2d& p, const Vector2d& d) {
  Vector2d t(-1e9, 1e9);
  for (std::size_t i = 0; i < convex.size(); ++i) {
    const Vector2d& a = convex[i];
    const Vector2d edge = convex[(i + 1) % convex.size()] - a;
    const double slope = cross(edge, d), height = cross(edge, p - a);
    if (slope == 0.0 && height < 0.0) return {1.0, 0.0};
    if (slope > 0.0) t[0] = std::max(t[0], -height / slope);
    if (slope < 0.0) t[1] = std::min(t[1], -height / slope);
  }
  return t;
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
      // Neighbours share a corner. They cross only if one runs back along the other.
      const Vector2d &apex = follows ? b : a, &one = follows ? a : b, &other = follows ? d : c;
      constexpr double kParallel = 1e-9;  // sine of the angle between them
      const Vector2d u = one - apex, v = other - apex;
      if (u.dot(v) >= 0.0 && std::abs(cross(u, v)) <= kParallel * u.norm() * v.norm()) {
        return std::pair{i, k};
      }
    }
  }
  return std::nullopt;
}

Polygon without_repeats(const Polygon& polygon) {
  constexpr double kSameCorner_m = 1e-6;
  Polygon clean;
  for (const Vector2d& p : polygon) {
    if (clean.empty() || (p - clean.back()).norm() > kSameCorner_m) clean.push_back(p);
  }
  while (clean.size() > 1 && (clean.front() - clean.back()).norm() <= kSameCorner_m) {
    clean.pop_back();
  }
  return clean;
}

Polygon widen(const Polygon& polygon, double margin_m) {
  if (margin_m == 0.0) return polygon;
  const double outward = signed_area_m2(polygon) > 0.0 ? -1.0 : 1.0;  // of the left normal
  Polygon wide;
  const std::size_t n = polygon.size();
  std::vector<std::size_t> first;  // of each corner's points
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d in = (polygon[i] - polygon[(i + n - 1) % n]).normalized();
    const Vector2d out = (polygon[(i + 1) % n] - polygon[i]).normalized();
    const Vector2d n_in = outward * left_of(in), n_out = outward * left_of(out);
    // The moved edges meet at margin (n_in + n_out) / (1 + n_in n_out) from the corner.
    const double spread = 1.0 + n_in.dot(n_out);
    first.push_back(wide.size());
    constexpr double kCutOff = 0.5;  // below it they meet farther away than twice the margin
    if (spread >= kCutOff) {
      wide.push_back(polygon[i] + margin_m / spread * (n_in + n_out));
    } else {
      wide.push_back(polygon[i] + margin_m * (n_in + in));
      wide.push_back(polygon[i] + margin_m * (n_out - out));
    }
  }
  // An edge that points backwards has vanished.
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d edge = polygon[(i + 1) % n] - polygon[i];
    const std::size_t end = first[(i + 1) % n], begin = (end + wide.size() - 1) % wide.size();
    if (edge.dot(wide[end] - wide[begin]) <= 0.0) return {};
  }
  return without_repeats(wide);
}

Polygon inset(const Polygon& convex, double inset_m) {
  // Sutherland and Hodgman: clips the polygon by each of its own edges, moved inwards.
  Polygon rest = convex;
  for (std::size_t i = 0; i < convex.size() && !rest.empty(); ++i) {
    const Vector2d along = convex[(i + 1) % convex.size()] - convex[i];
    const Vector2d inwards = left_of(along).normalized();
    const Vector2d on_line = convex[i] + inset_m * inwards;
    Polygon clipped;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      const Vector2d &a = rest[k], &b = rest[(k + 1) % rest.size()];
      const double da = inwards.dot(a - on_line), db = inwards.dot(b - on_line);
      if (da >= 0.0) clipped.push_back(a);
      if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
        clipped.push_back(a + da / (da - db) * (b - a));
      }
    }
    rest = std::move(clipped);
  }
  return rest.size() >= 3 ? rest : Polygon{};
}

}  // namespace vinerow
