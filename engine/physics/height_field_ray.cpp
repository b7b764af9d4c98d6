#include "engine/physics/height_field_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "engine/api/height_field.h"
#include "engine/api/scene_query.h"
#include "engine/core/constants.h"

namespace vinerow::physics {
namespace {

using Eigen::Vector3d;

/// Squares that the search visits, as levels of the height ranges: of 16 cells, then of 4.
constexpr int kBlockLevel = 2, kSquareLevel = 0;
constexpr int cells_of_level(int level) {
  return HeightRanges::kCells << level;
}

}  // namespace

/// Ray in grid units (x, y in cells, z in metres) and the result of its traversal.
struct HeightFieldRay::Walk {
  double g[2], d[2], per_d[2];  // cells, cells per metre of ray, metres per cell
  double z, dz;
  double level, dlevel, per_dlevel;  // height above the plane of the ranges
  int side = 0;                      // sign of D so far; 0 at the start
  double hit_t = 0.0;
  double slope_x = 0.0, slope_y = 0.0;  // slope of the hit triangle, dh per cell
};

/// Traversal of squares along a ray: each square with its range of t.
class HeightFieldRay::GridWalk {
 public:
  /// @param cells  along a side of a square
  /// @param low,high  squares [low, high) along each axis
  GridWalk(const Walk& walk, int cells, const int low[2], const int high[2], double t0) {
    for (int axis = 0; axis < 2; ++axis) {
      const double d = walk.d[axis];
      const auto cell = static_cast<int>(walk.g[axis] + t0 * d);
      low_[axis] = low[axis];
      high_[axis] = high[axis];
      index_[axis] = std::clamp(cell / cells, low[axis], high[axis] - 1);
      step_[axis] = d > 0.0 ? 1 : -1;
      per_square_[axis] = std::abs(walk.per_d[axis]) * cells;
      const int edge = (index_[axis] + (d > 0.0 ? 1 : 0)) * cells;
      next_[axis] = d == 0.0 ? kInfinity : (edge - walk.g[axis]) * walk.per_d[axis];
    }
  }
  int i() const { return index_[0]; }
  int j() const { return index_[1]; }
  /// t at which the line leaves this square.
  double exit_t() const { return std::min(next_[0], next_[1]); }
  /// Moves to the next square. @returns false at the border
  bool advance() {
    const int axis = next_[0] <= next_[1] ? 0 : 1;
    index_[axis] += step_[axis];
    next_[axis] += per_square_[axis];
    return index_[axis] >= low_[axis] && index_[axis] < high_[axis];
  }

 private:
  int low_[2], high_[2], index_[2], step_[2];
  double per_square_[2], next_[2];
};

/// The plane of the slope: the least squares of all samples. On a regular grid both slopes follow
/// alone.
Eigen::Vector2d HeightFieldRay::calc_tilt_m(const HeightField& field) {
  Eigen::Vector2d moment = Eigen::Vector2d::Zero(), spread = Eigen::Vector2d::Zero();
  const Eigen::Vector2d middle(0.5 * (field.columns - 1), 0.5 * (field.rows - 1));
  const float* height_m = field.heights_m.data();
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i, ++height_m) {
      const Eigen::Vector2d from_middle = Eigen::Vector2d(i, j) - middle;
      moment += *height_m * from_middle;
      spread += from_middle.cwiseAbs2();
    }
  }
  return moment.cwiseQuotient(spread);
}

HeightFieldRay::HeightFieldRay(const HeightField& field)
    : field_(field),
      inverse_cell_per_m_(1.0 / field.cell_m),
      tilt_m_(calc_tilt_m(field)),
      ranges_(field, tilt_m_) {
  double steepest2_m2 = 0.0;  // square of the rise per cell, above the plane
  for (int j = 0; j + 1 < field.rows; ++j) {
    for (int i = 0; i + 1 < field.columns; ++i) {
      const float* row = field.heights_m.data() + static_cast<std::size_t>(j) * field.columns + i;
      const double h00 = row[0], h10 = row[1];
      const double h01 = row[field.columns], h11 = row[field.columns + 1];
      const auto square = [this](double along_x, double along_y) {
        return (Eigen::Vector2d(along_x, along_y) - tilt_m_).squaredNorm();
      };
      steepest2_m2 =
          std::max({steepest2_m2, square(h10 - h00, h11 - h10), square(h11 - h01, h01 - h00)});
    }
  }
  steepest_ = std::sqrt(steepest2_m2) * inverse_cell_per_m_;
}

/// @returns true if a ray rises more steeply than the surface does anywhere
bool HeightFieldRay::outclimbs(const Vector3d& dir_W) const {
  constexpr double kRounding = 1e-9;
  const double climb = climb_of(dir_W);
  return climb > 0.0 &&
         climb * climb >
             (1.0 + kRounding) * steepest_ * steepest_ * dir_W.head<2>().squaredNorm() + kRounding;
}

/// Height of a point above the surface, less what rounding could change; negative outside the grid.
double HeightFieldRay::gap_m(const Vector3d& p_W) const {
  constexpr double kRounding_m = 1e-6;
  if (!field_.contains(p_W.x(), p_W.y())) return -1.0;
  return p_W.z() - field_.height_m(p_W.x(), p_W.y()) - kRounding_m;
}

/// Over the grid the gap shrinks by at most  (steepest across - climb)  per metre of ray, with
/// `across` the horizontal part of its direction. Once beyond the edge, a ray does not return.
bool HeightFieldRay::stays_above(const SceneRay& ray, Origin& origin) const {
  if (origin.p_W != ray.p_W) origin = {ray.p_W, gap_m(ray.p_W)};
  if (!(origin.gap_m > 0.0)) return false;
  constexpr double kRounding = 1e-9;
  const double left_m = origin.gap_m + ray.max_distance_m * climb_of(ray.dir_W);
  const double steepest_m = ray.max_distance_m * steepest_;
  return left_m > 0.0 && left_m * left_m > (1.0 + kRounding) * steepest_m * steepest_m *
                                               ray.dir_W.head<2>().squaredNorm();
}

/// Limits the ray to its section between two heights above the plane. Before it the side is
/// constant, so it need not be traversed. @returns false if nothing is left
bool HeightFieldRay::clip(Walk& walk, double low_m, double high_m, double& t0, double& t1) {
  // The margin keeps rounding from cutting off a crossing of the highest or lowest sample.
  constexpr double kMargin_m = 1e-3;
  low_m -= kMargin_m;
  high_m += kMargin_m;
  if (walk.dlevel == 0.0) return walk.level <= high_m && walk.level >= low_m;
  const double at_low = (low_m - walk.level) * walk.per_dlevel;
  const double at_high = (high_m - walk.level) * walk.per_dlevel;
  const double enter = std::min(at_low, at_high);
  if (enter > t0) {
    walk.side = walk.dlevel < 0.0 ? 1 : -1;
    t0 = enter;
  }
  t1 = std::min(t1, std::max(at_low, at_high));
  return t0 <= t1;
}

/// Limits a ray that falls more steeply than the surface does anywhere. Its D shrinks by
/// fall - steepest across  to  fall + steepest across  per metre, with `across` the horizontal part
/// of its direction: D at its end bounds how long ago it was 0.
/// @pre the ray is over the grid. @returns false if nothing is left
bool HeightFieldRay::clip_dive(Walk& walk, const Vector3d& p_W, const Vector3d& dir_W, double& t0,
                               double& t1) const {
  constexpr double kSlowest = 0.4;  // chosen: below it what is left is too long to save anything
  constexpr double kRounding_m = 1e-6, kMargin_m = 1e-3;
  const double across = steepest_ * dir_W.head<2>().norm();
  const double slow = -walk.dlevel - across, fast = -walk.dlevel + across;
  if (!(slow > kSlowest)) return true;
  const Vector3d end_W = p_W + t1 * dir_W;
  const double below_m = field_.height_m(end_W.x(), end_W.y()) - end_W.z();
  if (below_m < -kRounding_m) return false;
  const double enter = t1 - (below_m + kMargin_m) / slow;
  if (enter > t0) {
    walk.side = 1;
    t0 = enter;
  }
  t1 -= std::max(0.0, below_m - kMargin_m) / fast;
  return true;
}

/// Limits the ray to where it is as high as some ground under it. What is left covers less ground,
/// whose heights differ less: this is repeated until little is gained. @returns false if nothing is
/// left
bool HeightFieldRay::clip_to_ground(Walk& walk, double& t0, double& t1) const {
  const auto square = [&](int axis, double t, int squares) {
    const auto cell = static_cast<int>(walk.g[axis] + t * walk.d[axis]);
    return std::clamp(cell / HeightRanges::kCells, 0, squares - 1);
  };
  for (bool gains = true; gains;) {
    const auto [i0, i1] =
        std::minmax({square(0, t0, ranges_.columns()), square(0, t1, ranges_.columns())});
    const auto [j0, j1] =
        std::minmax({square(1, t0, ranges_.rows()), square(1, t1, ranges_.rows())});
    const HeightRanges::Range range = ranges_.of(i0, j0, i1, j1);
    const double length = t1 - t0;
    if (!clip(walk, range.low_m, range.high_m, t0, t1)) return false;
    gains = t1 - t0 < 0.5 * length;
  }
  return true;
}

/// Finds the crossing inside one cell. @returns true if found
bool HeightFieldRay::cross_cell(Walk& walk, int i, int j, double t0, double t1) const {
  const float* row = field_.heights_m.data() + static_cast<std::size_t>(j) * field_.columns + i;
  const double h00 = row[0];
  const double h10 = row[1];
  const double h01 = row[field_.columns];
  const double h11 = row[field_.columns + 1];

  // Clear of all four corners, by more than rounding: no crossing.
  constexpr double kClear_m = 1e-6;
  const double z0 = walk.z + walk.dz * t0, z1 = walk.z + walk.dz * t1;
  if (walk.side > 0 &&
      std::min(z0, z1) > std::max(std::max(h00, h10), std::max(h01, h11)) + kClear_m) {
    return false;
  }

  // D(t) = d0 + rate * t for the planes of the lower right (u >= v) and the upper left triangle.
  const double u = walk.g[0] - i;
  const double v = walk.g[1] - j;
  const auto look = [&](bool lower, double from, double to) {
    const double slope_x = lower ? h10 - h00 : h11 - h01;
    const double slope_y = lower ? h11 - h10 : h01 - h00;
    const double d0 = walk.z - (h00 + u * slope_x + v * slope_y);
    const double rate = walk.dz - (walk.d[0] * slope_x + walk.d[1] * slope_y);
    const double d_from = d0 + rate * from;
    const double d_to = d0 + rate * to;
    if (walk.side == 0) walk.side = d_from > 0.0 ? 1 : (d_from < 0.0 ? -1 : 0);
    // side is still 0 if the ray starts on the surface: an immediate hit. A change of sign between
    // two sections is rounding, and a hit at their border.
    const bool changed = walk.side == 0 || d_from * walk.side <= 0.0;
    if (!changed && d_to * walk.side > 0.0) return false;
    walk.hit_t = changed || rate == 0.0 ? from : std::clamp(-d0 / rate, from, to);
    walk.slope_x = slope_x;
    walk.slope_y = slope_y;
    return true;
  };

  // The sign of u - v along the ray selects the triangle; it changes at most once.
  const double across = u - v;
  const double across_rate = walk.d[0] - walk.d[1];
  const double across0 = across + across_rate * t0;
  const double across1 = across + across_rate * t1;
  const bool lower0 = across0 >= 0.0;
  const bool lower1 = across1 >= 0.0;
  if (lower0 == lower1) return look(lower0, t0, t1);
  const double t_mid = std::clamp(-across / across_rate, t0, t1);
  return look(lower0, t0, t_mid) || look(lower1, t_mid, t1);
}

/// Finds the crossing in the squares of `cells` cells between two corners, in cells.
/// @param cross  of a square: bool(i, j, t0, t1)
template <class Cross>
bool HeightFieldRay::cross_squares(const Walk& walk, int cells, const int corner[2],
                                   const int end[2], double t0, double t1, const Cross& cross) {
  const int low[2] = {corner[0] / cells, corner[1] / cells};
  const int high[2] = {(end[0] - 1) / cells + 1, (end[1] - 1) / cells + 1};
  GridWalk squares(walk, cells, low, high, t0);
  double from = t0;
  do {
    const double to = std::clamp(squares.exit_t(), from, t1);
    if (cross(squares.i(), squares.j(), from, to)) return true;
    from = to;
  } while (from < t1 && squares.advance());
  return false;
}

/// @returns true if the ray is strictly above or below a whole square. No crossing, and the side is
/// known.
bool HeightFieldRay::is_clear(Walk& walk, int level, int i, int j, double t0, double t1) const {
  constexpr double kRounding_m = 1e-6;
  const HeightRanges::Range range = ranges_.square(level, i, j);
  const double level0 = walk.level + walk.dlevel * t0;
  const double level1 = walk.level + walk.dlevel * t1;
  const int side = std::min(level0, level1) > range.high_m + kRounding_m  ? 1
                   : std::max(level0, level1) < range.low_m - kRounding_m ? -1
                                                                          : 0;
  if (side == 0 || (walk.side != 0 && walk.side != side)) return false;
  walk.side = side;
  return true;
}

bool HeightFieldRay::cross_square(Walk& walk, int level, int i, int j, double t0, double t1) const {
  if (is_clear(walk, level, i, j, t0, t1)) return false;
  const int cells = cells_of_level(level);
  const int corner[2] = {i * cells, j * cells};
  const int end[2] = {std::min(corner[0] + cells, field_.columns - 1),
                      std::min(corner[1] + cells, field_.rows - 1)};
  if (level == kSquareLevel) {
    return cross_squares(walk, 1, corner, end, t0, t1, [&](int ci, int cj, double from, double to) {
      return cross_cell(walk, ci, cj, from, to);
    });
  }
  return cross_squares(walk, cells_of_level(kSquareLevel), corner, end, t0, t1,
                       [&](int si, int sj, double from, double to) {
                         return cross_square(walk, kSquareLevel, si, sj, from, to);
                       });
}

std::optional<HeightFieldRay::Hit> HeightFieldRay::cast(const Vector3d& p_W, const Vector3d& dir_W,
                                                        double max_distance_m) const {
  Walk walk;
  walk.g[0] = (p_W.x() - field_.corner_W.x()) * inverse_cell_per_m_;
  walk.g[1] = (p_W.y() - field_.corner_W.y()) * inverse_cell_per_m_;
  walk.d[0] = dir_W.x() * inverse_cell_per_m_;
  walk.d[1] = dir_W.y() * inverse_cell_per_m_;
  walk.z = p_W.z();
  walk.dz = dir_W.z();
  walk.level = walk.z - (tilt_m_.x() * walk.g[0] + tilt_m_.y() * walk.g[1]);
  walk.dlevel = climb_of(dir_W);

  // Non-finite, or far beyond any grid: no hit, and the cell index could overflow.
  constexpr double kFarAway = 1e9;
  if (!(std::abs(walk.g[0]) < kFarAway && std::abs(walk.g[1]) < kFarAway &&
        std::abs(walk.z) < kFarAway && dir_W.squaredNorm() < 2.0 && max_distance_m >= 0.0)) {
    return std::nullopt;
  }
  if (outclimbs(dir_W) && gap_m(p_W) > 0.0) return std::nullopt;
  // Neither a short ray over the inside of one cell, such as most of a wheel's, nor one that ends
  // above all ground near it needs clipping or traversal, whose divisions would take most of its
  // time.
  double t0 = 0.0;
  double t1 = max_distance_m;
  if (const std::optional<Span> span = span_of(walk, max_distance_m)) {
    if (span->is_one_cell()) {
      return cross_cell(walk, span->i0, span->j0, 0.0, max_distance_m) ? hit_of(walk, dir_W)
                                                                       : std::optional<Hit>();
    }
    if (is_above(walk, *span, max_distance_m)) return std::nullopt;
    if (!clip_dive(walk, p_W, dir_W, t0, t1)) return std::nullopt;
  }
  walk.per_dlevel = 1.0 / walk.dlevel;

  // Section of the ray over the grid.
  const double extent[2] = {field_.columns - 1.0, field_.rows - 1.0};
  for (int axis = 0; axis < 2; ++axis) {
    if (walk.d[axis] == 0.0) {
      if (walk.g[axis] < 0.0 || walk.g[axis] > extent[axis]) return std::nullopt;
      walk.per_d[axis] = kInfinity;
      continue;
    }
    walk.per_d[axis] = 1.0 / walk.d[axis];
    const double at_low = -walk.g[axis] * walk.per_d[axis];
    const double at_high = (extent[axis] - walk.g[axis]) * walk.per_d[axis];
    t0 = std::max(t0, std::min(at_low, at_high));
    t1 = std::min(t1, std::max(at_low, at_high));
  }
  if (!(t0 <= t1)) return std::nullopt;

  if (!clip(walk, ranges_.all().low_m, ranges_.all().high_m, t0, t1)) return std::nullopt;

  // What is left may be inside one cell.
  const auto cell_of = [&](int axis, double t, int last) {
    return std::clamp(static_cast<int>(walk.g[axis] + t * walk.d[axis]), 0, last);
  };
  const int i = cell_of(0, t0, field_.columns - 2);
  const int j = cell_of(1, t0, field_.rows - 2);
  bool found = false;
  if (i == cell_of(0, t1, field_.columns - 2) && j == cell_of(1, t1, field_.rows - 2)) {
    found = cross_cell(walk, i, j, t0, t1);
  } else {
    // A few cells are searched one by one: squares would only add to them.
    constexpr int kFewCells = 4;
    int i0, i1, j0, j1;
    const auto are_few = [&] {
      std::tie(i0, i1) =
          std::minmax({cell_of(0, t0, field_.columns - 2), cell_of(0, t1, field_.columns - 2)});
      std::tie(j0, j1) =
          std::minmax({cell_of(1, t0, field_.rows - 2), cell_of(1, t1, field_.rows - 2)});
      return i1 - i0 < kFewCells && j1 - j0 < kFewCells;
    };
    if (!are_few() && !clip_to_ground(walk, t0, t1)) return std::nullopt;
    if (are_few()) {
      const int corner[2] = {i0, j0}, end[2] = {i1 + 1, j1 + 1};
      found =
          cross_squares(walk, 1, corner, end, t0, t1, [&](int ci, int cj, double from, double to) {
            return cross_cell(walk, ci, cj, from, to);
          });
    } else {
      const int corner[2] = {0, 0}, end[2] = {field_.columns - 1, field_.rows - 1};
      found = cross_squares(walk, cells_of_level(kBlockLevel), corner, end, t0, t1,
                            [&](int bi, int bj, double from, double to) {
                              return cross_square(walk, kBlockLevel, bi, bj, from, to);
                            });
    }
  }
  if (!found) return std::nullopt;
  return hit_of(walk, dir_W);
}

/// The cells of a ray's ends, if both are on the grid.
std::optional<HeightFieldRay::Span> HeightFieldRay::span_of(const Walk& walk,
                                                            double max_distance_m) const {
  const double end_x = walk.g[0] + max_distance_m * walk.d[0];
  const double end_y = walk.g[1] + max_distance_m * walk.d[1];
  const bool is_inside = walk.g[0] >= 0.0 && walk.g[1] >= 0.0 && end_x >= 0.0 && end_y >= 0.0 &&
                         std::max(walk.g[0], end_x) < field_.columns - 1 &&
                         std::max(walk.g[1], end_y) < field_.rows - 1;
  if (!is_inside) return std::nullopt;
  return Span{static_cast<int>(walk.g[0]), static_cast<int>(walk.g[1]), static_cast<int>(end_x),
              static_cast<int>(end_y)};
}

/// @returns true if the ray is above all ground of the rectangle of squares around it; false for
/// long rays, whose rectangle has too much of it
bool HeightFieldRay::is_above(const Walk& walk, const Span& span, double max_distance_m) const {
  constexpr int kLongest = 64;  // cells. Chosen
  if (std::abs(span.i1 - span.i0) + std::abs(span.j1 - span.j0) > kLongest) return false;
  constexpr double kMargin_m = 1e-3;
  const auto [i0, i1] =
      std::minmax({span.i0 / HeightRanges::kCells, span.i1 / HeightRanges::kCells});
  const auto [j0, j1] =
      std::minmax({span.j0 / HeightRanges::kCells, span.j1 / HeightRanges::kCells});
  const double lowest_m = std::min(walk.level, walk.level + max_distance_m * walk.dlevel);
  return lowest_m > ranges_.of(i0, j0, i1, j1).high_m + kMargin_m;
}

HeightFieldRay::Hit HeightFieldRay::hit_of(const Walk& walk, const Vector3d& dir_W) const {
  Hit hit;
  hit.distance_m = walk.hit_t;
  hit.normal_W =
      Vector3d(-walk.slope_x * inverse_cell_per_m_, -walk.slope_y * inverse_cell_per_m_, 1.0)
          .normalized();
  if (hit.normal_W.dot(dir_W) > 0.0) hit.normal_W = -hit.normal_W;
  return hit;
}

}  // namespace vinerow::physics
