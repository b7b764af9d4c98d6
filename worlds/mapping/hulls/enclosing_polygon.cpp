#include "worlds/mapping/hulls/enclosing_polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/core/constants.h"
#include "engine/math/planar.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;

constexpr double kLargestCoordinate = 1e9;
constexpr double kThinnest = 1e-9;  ///< hull area over extent squared: below, points on a line
/// A hull corner that stands out by less, over the extent, is rounding. It would give a side that
/// points anywhere. Far above the rounding of what is measured, far below what is promised.
constexpr double kFlat = 1e-14;

/// The hull without corners that stand out by less than flat_m from the line of their neighbours.
Polygon without_flat_corners(Polygon hull, double flat_m) {
  // The corner farthest from another is never flat: begin there.
  const Vector2d other = hull[0];
  const auto farthest =
      std::max_element(hull.begin(), hull.end(), [&](const Vector2d& a, const Vector2d& b) {
        return (a - other).squaredNorm() < (b - other).squaredNorm();
      });
  std::rotate(hull.begin(), farthest, hull.end());
  Polygon kept;
  const auto drop_flat_before = [&](const Vector2d& next) {
    while (kept.size() > 1) {
      const Vector2d &a = kept[kept.size() - 2], &b = kept.back();
      if (cross(b - a, next - a) > flat_m * (next - a).norm()) return;
      kept.pop_back();
    }
  };
  for (const Vector2d& corner : hull) {
    drop_flat_before(corner);
    kept.push_back(corner);
  }
  drop_flat_before(kept.front());
  return kept;
}

/// A side that is not along the hull: it touches one corner with its middle.
struct FreeSide {
  int before;  ///< the hull's side that it follows
  Vector2d from, to;
  double added_m2;  ///< between it, the lines of the sides around it and the hull
};

/// A convex polygon's sides, side i from corner i to i + 1, taken modulo their number, and what
/// leaving some of them out adds to its area.
class Sides {
 public:
  explicit Sides(const Polygon& hull) : origin_(hull[0]), count_(static_cast<int>(hull.size())) {
    for (const Vector2d& corner : hull) corners_.push_back(corner - origin_);
    swept_m2_.push_back(0.0);
    for (int i = 0; i < 2 * count_; ++i) {
      swept_m2_.push_back(swept_m2_.back() + 0.5 * cross(corner(i), corner(i + 1)));
    }
  }

  int count() const { return count_; }

  /// The smallest triangle, quadrilateral, ... whose sides are these of the hull.
  /// @param kept  rising, no two neighbours pi or more apart
  Polygon polygon(const std::vector<int>& kept) const {
    Polygon polygon;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const bool last = k + 1 == kept.size();
      polygon.push_back(origin_ + meet(kept[k], last ? kept[0] + count_ : kept[k + 1]));
    }
    return polygon;
  }

  /// The same with a free side between the last and the first.
  Polygon polygon(const std::vector<int>& kept, const FreeSide& free) const {
    Polygon polygon;
    for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
      polygon.push_back(origin_ + meet(kept[k], kept[k + 1]));
    }
    polygon.push_back(origin_ + free.from);
    polygon.push_back(origin_ + free.to);
    return polygon;
  }

  /// Between the hull and the lines of sides i and j, where these meet behind the sides between
  /// them; infinite where they do not. @pre i < j < i + count
  double pocket_m2(int i, int j) const {
    if (cross(along(i), along(j)) <= 0.0) return kInfinity;
    const Vector2d &a = corner(i + 1), &b = corner(j);
    return 0.5 * cross(meet(i, j) - a, b - a) - bulge_m2(i + 1, j);
  }

  /// The side through corner k whose middle touches it, ends on the lines of sides i and j.
  /// Only where these open away from each other, by more than pi: there it is the smallest; where
  /// they meet behind it, it is the largest, and a side of the hull is smaller.
  /// @pre i < k - 1, k < j < i + count
  std::optional<FreeSide> free_side(int i, int k, int j) const {
    const double turn = cross(along(i), along(j));
    if (turn >= 0.0) return std::nullopt;
    // a = corner(i + 1) + s along(i), b = corner(j) - t along(j), a + b = 2 corner(k).
    const Vector2d rest = 2.0 * corner(k) - corner(i + 1) - corner(j);
    const double s = cross(rest, along(j)) / turn, t = cross(rest, along(i)) / turn;
    if (s < 0.0 || t < 0.0) return std::nullopt;
    const Vector2d a = corner(i + 1) + s * along(i), b = corner(j) - t * along(j), side = b - a;
    if (cross(along(k - 1), side) < 0.0 || cross(side, along(k)) < 0.0) return std::nullopt;
    const Vector2d chord = corner(j) - corner(i + 1);
    const double outer_m2 =
        0.5 * (cross(a - corner(i + 1), b - corner(i + 1)) + cross(b - corner(i + 1), chord));
    return FreeSide{i, a, b, outer_m2 - bulge_m2(i + 1, j)};
  }

 private:
  const Vector2d& corner(int i) const { return corners_[i % count_]; }
  Vector2d along(int i) const { return corner(i + 1) - corner(i); }

  Vector2d meet(int i, int j) const {
    const Vector2d gap = corner(j) - corner(i + 1);
    return corner(i + 1) + cross(gap, along(j)) / cross(along(i), along(j)) * along(i);
  }

  /// Between the hull's way from corner i on to corner j and the straight line. @pre i <= j
  double bulge_m2(int i, int j) const {
    return swept_m2_[j] - swept_m2_[i] + 0.5 * cross(corner(j), corner(i));
  }

  Vector2d origin_;
  int count_;
  Polygon corners_;               // from the first
  std::vector<double> swept_m2_;  // from the first corner, up to corner i, twice around
};

/// The cheapest way around the hull in steps from one kept side to the next.
class Search {
 public:
  /// @param max_m2  added area; what adds more is not looked at
  Search(const Polygon& hull, int corners, double max_m2)
      : sides_(hull), n_(sides_.count()), steps_(corners), best_m2_(max_m2), free_(n_) {
    // Pockets lie in each other, so the first that is too large ends the row.
    for (int i = 0; i < n_; ++i) {
      pockets_.emplace_back(1, 0.0);
      for (int far = 1; far < n_; ++far) {
        const double pocket_m2 = sides_.pocket_m2(i, i + far);
        if (!(pocket_m2 <= max_m2) || pocket_m2 == kInfinity) break;
        pockets_.back().push_back(pocket_m2);
      }
    }
    // The area at a free side holds the pockets before and behind the corner that it touches.
    for (int i = 0; i < n_; ++i) {
      for (int k = i + 2; k <= i + 1 + reach(i); ++k) {
        for (int j = k + 1; j <= std::min(k + reach(k), i + n_ - 1); ++j) {
          const std::optional<FreeSide> free = sides_.free_side(i, k, j);
          if (free && free->added_m2 < max_m2) free_[j % n_].push_back(*free);
        }
      }
    }
    costs_.assign(steps_ + 1, std::vector<double>(n_ + 1));
    origins_.assign(steps_ + 1, std::vector<int>(n_ + 1));
  }

  /// @returns empty if nothing adds less than allowed
  Polygon run() {
    // Sides that no step leads over: one of them is kept, unless a free side is over them.
    int sill = 0;
    for (int i = 1; i < n_; ++i) {
      if (reach(i) < reach(sill)) sill = i;
    }
    for (int i = 0; i < n_; ++i) {
      const bool in_sill = (i - sill - 1 + n_) % n_ < reach(sill);
      if (in_sill || !free_[i].empty()) start_at(i);
    }
    return best_;
  }

 private:
  /// Farthest step from side i.
  int reach(int i) const { return static_cast<int>(pockets_[i % n_].size()) - 1; }

  /// costs_[m][e]: least area added by m steps from side `start` to side start + e.
  void start_at(int start) {
    std::fill(costs_[0].begin(), costs_[0].end(), kInfinity);
    costs_[0][0] = 0.0;
    for (int m = 0; m < steps_; ++m) {
      std::fill(costs_[m + 1].begin(), costs_[m + 1].end(), kInfinity);
      for (int e = m; e < n_; ++e) {
        if (!(costs_[m][e] < best_m2_)) continue;
        const std::vector<double>& pockets = pockets_[(start + e) % n_];
        for (int far = 1; far <= std::min(reach(start + e), n_ - e); ++far) {
          const double cost = costs_[m][e] + pockets[far];
          if (cost >= costs_[m + 1][e + far]) continue;
          costs_[m + 1][e + far] = cost;
          origins_[m + 1][e + far] = e;
        }
      }
    }
    if (costs_[steps_][n_] < best_m2_) {
      best_m2_ = costs_[steps_][n_];
      best_ = sides_.polygon(way(start, steps_ - 1, origins_[steps_][n_]));
    }
    for (const FreeSide& free : free_[start]) {
      const int e = (free.before - start + n_) % n_;
      const double cost = costs_[steps_ - 2][e] + free.added_m2;
      if (cost >= best_m2_) continue;
      best_m2_ = cost;
      best_ = sides_.polygon(way(start, steps_ - 2, e), free);
    }
  }

  /// The sides of the cheapest way of m steps that ends at start + e.
  std::vector<int> way(int start, int m, int e) const {
    std::vector<int> kept;
    for (; m > 0; --m) {
      kept.push_back(start + e);
      e = origins_[m][e];
    }
    kept.push_back(start);
    std::reverse(kept.begin(), kept.end());
    return kept;
  }

  Sides sides_;
  int n_, steps_;
  double best_m2_;
  Polygon best_;
  std::vector<std::vector<double>> pockets_;  // [i][far] of sides i and i + far
  std::vector<std::vector<FreeSide>> free_;   // [j] that side j follows
  std::vector<std::vector<double>> costs_;
  std::vector<std::vector<int>> origins_;  // the side that the last step of costs_ began at
};

/// A bound for the search: takes from the hull, again and again, the side that adds the least area;
/// a triangle is then the smallest around the quadrilateral. Around noisy canopy sections 0.1 %
/// above the least area with 8 corners (at worst 1.1 %), 6 % (21 %) with 4.
/// @pre more hull corners than `corners`
Polygon greedy(const Polygon& hull, int corners) {
  const Sides sides(hull);
  std::vector<int> kept(hull.size());
  for (int i = 0; i < sides.count(); ++i) kept[i] = i;
  // Of five sides or more, the neighbours of one at least turn by less than pi. Of a parallelogram
  // none do.
  while (static_cast<int>(kept.size()) > std::max(corners, 4)) {
    const std::size_t left = kept.size();
    const auto side = [&](std::size_t k) {
      return k < left ? kept[k] : kept[k - left] + sides.count();
    };
    double min_m2 = kInfinity;
    std::size_t out = 0;
    for (std::size_t k = 0; k < left; ++k) {
      const int before = side(k), middle = side(k + 1), behind = side(k + 2);
      const double added_m2 = sides.pocket_m2(before, behind) - sides.pocket_m2(before, middle) -
                              sides.pocket_m2(middle, behind);
      if (!(added_m2 < min_m2)) continue;
      min_m2 = added_m2;
      out = (k + 1) % left;
    }
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(out));
  }
  const Polygon polygon = sides.polygon(kept);
  return corners == 3 ? Search(polygon, 3, kInfinity).run() : polygon;
}

Result<Polygon> checked_hull(const Polygon& points, int corners) {
  if (corners < 3) return Failure{fmt::format("a polygon of {} corners has no area", corners)};
  if (points.empty()) return Failure{"there are no points to enclose"};
  Vector2d low = points[0], high = points[0];
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d& p = points[i];
    if (!(p.cwiseAbs().maxCoeff() <= kLargestCoordinate) || !p.allFinite()) {
      return Failure{fmt::format("point {} is ({}, {}), must be finite and within {:g} of 0", i,
                                 p.x(), p.y(), kLargestCoordinate)};
    }
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double extent = (high - low).norm();
  Polygon hull = convex_hull(points);
  if (!(signed_area_m2(hull) > kThinnest * extent * extent)) {
    return Failure{fmt::format(
        "{} points on one line or in one place have no polygon of least area around them",
        points.size())};
  }
  return without_flat_corners(std::move(hull), kFlat * extent);
}

}  // namespace

Result<Polygon> smallest_enclosing_polygon(const Polygon& points, int corners) {
  const Result<Polygon> hull = checked_hull(points, corners);
  if (!hull || static_cast<int>(hull->size()) <= corners) return hull;
  const Polygon fast = greedy(*hull, corners);
  // Up to rounding, so that the search may find the same.
  const double hull_m2 = signed_area_m2(*hull), fast_m2 = signed_area_m2(fast);
  const double max_m2 = (fast_m2 - hull_m2) + 1e-12 * fast_m2;
  const Polygon best = Search(*hull, corners, max_m2).run();
  return !best.empty() && signed_area_m2(best) < fast_m2 ? best : fast;
}

}  // namespace vinerow::mapping
