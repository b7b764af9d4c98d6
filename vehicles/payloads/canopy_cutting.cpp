#include "vehicles/payloads/canopy_cutting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/check.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector3d;

/// A convex polygon of a few corners: a triangle gets one more by each of at most five cuts.
struct Piece {
  static constexpr std::size_t kMax = 10;
  std::array<CanopyPoint, kMax> corners;
  std::size_t count = 0;

  void add(const CanopyPoint& point) {
    VINEROW_ASSERT(count < kMax);
    corners[count++] = point;
  }
};

CanopyPoint point_between(const CanopyPoint& a, const CanopyPoint& b, double share) {
  CanopyPoint point;
  point.row = a.row;
  point.p_W = a.p_W + share * (b.p_W - a.p_W);
  point.along_m = a.along_m + share * (b.along_m - a.along_m);
  point.lateral_m = a.lateral_m + share * (b.lateral_m - a.lateral_m);
  point.height_m = a.height_m + share * (b.height_m - a.height_m);
  return point;
}

/// Both halves of a polygon, cut where `value` of its corners is `at`.
void cut_piece(const Piece& whole, double CanopyPoint::*value, double at, Piece& below,
               Piece& above) {
  below.count = above.count = 0;
  for (std::size_t i = 0; i < whole.count; ++i) {
    const CanopyPoint& a = whole.corners[i];
    const CanopyPoint& b = whole.corners[(i + 1) % whole.count];
    const double from = a.*value - at, to = b.*value - at;
    if (from <= 0.0) below.add(a);
    if (from >= 0.0) above.add(a);
    if ((from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0)) {
      CanopyPoint border = point_between(a, b, from / (from - to));
      border.*value = at;
      below.add(border);
      above.add(border);
    }
  }
}

/// Hands out the strips of a polygon between multiples of `width`, with their numbers.
template <class F>
void cut_into_strips(Piece rest, double CanopyPoint::*value, double width, F&& take) {
  double min_value = rest.corners[0].*value, max_value = min_value;
  for (std::size_t i = 1; i < rest.count; ++i) {
    min_value = std::min(min_value, rest.corners[i].*value);
    max_value = std::max(max_value, rest.corners[i].*value);
  }
  int strip = static_cast<int>(std::floor(min_value / width));
  Piece below, above;
  for (; (strip + 1) * width < max_value; ++strip) {
    cut_piece(rest, value, (strip + 1) * width, below, above);
    if (below.count >= 3) take(below, strip);
    rest = above;
    if (rest.count < 3) return;
  }
  take(rest, strip);
}

void hand_over(const Piece& piece, int side, int along, int band,
               const std::function<void(const CanopyPiece&)>& take) {
  CanopyPiece result{piece.corners[0].row, side, along, band, 0.0, Vector3d::Zero()};
  const Vector3d& first = piece.corners[0].p_W;
  for (std::size_t i = 1; i + 1 < piece.count; ++i) {
    const Vector3d &b = piece.corners[i].p_W, &c = piece.corners[i + 1].p_W;
    const double area_m2 = 0.5 * (b - first).cross(c - first).norm();
    result.area_m2 += area_m2;
    result.middle_W += area_m2 / 3.0 * (first + b + c);
  }
  if (!(result.area_m2 > 0.0)) return;
  result.middle_W /= result.area_m2;
  take(result);
}

struct Cutter {
  const RowLines& rows;
  double step_m;
  double band_m;
  const std::function<void(const CanopyPiece&)>& take;

  bool is_linear(const CanopyPoint& a, const CanopyPoint& b, const CanopyPoint& c) const {
    if (a.row != b.row || b.row != c.row) return false;
    const double tolerance_m = 0.005 * std::min(step_m, band_m);
    const auto fits = [&](const Vector3d& p_W, double along_m, double lateral_m, double height_m) {
      const CanopyPoint point = canopy_point(rows, p_W);
      return point.row == a.row && std::abs(point.along_m - along_m) < tolerance_m &&
             std::abs(point.lateral_m - lateral_m) < tolerance_m &&
             std::abs(point.height_m - height_m) < tolerance_m;
    };
    const auto fits_between = [&](const CanopyPoint& p, const CanopyPoint& q) {
      const CanopyPoint middle = point_between(p, q, 0.5);
      return fits(middle.p_W, middle.along_m, middle.lateral_m, middle.height_m);
    };
    if (!fits((a.p_W + b.p_W + c.p_W) / 3.0, (a.along_m + b.along_m + c.along_m) / 3.0,
              (a.lateral_m + b.lateral_m + c.lateral_m) / 3.0,
              (a.height_m + b.height_m + c.height_m) / 3.0)) {
      return false;
    }
    // A long one may bend to both sides of its middle.
    const double longest_m =
        std::max({(b.p_W - a.p_W).norm(), (c.p_W - b.p_W).norm(), (a.p_W - c.p_W).norm()});
    if (longest_m <= 2.0 * step_m) return true;
    if (longest_m > 20.0 * step_m) return false;
    return fits_between(a, b) && fits_between(b, c) && fits_between(c, a);
  }

  void divide(const CanopyPoint& a, const CanopyPoint& b, const CanopyPoint& c) const {
    if (is_linear(a, b, c)) {
      cut_linear(a, b, c);
      return;
    }
    const double area_m2 = 0.5 * (b.p_W - a.p_W).cross(c.p_W - a.p_W).norm();
    if (area_m2 < 1e-2 * step_m * band_m) {
      const Vector3d middle_W = (a.p_W + b.p_W + c.p_W) / 3.0;
      const CanopyPoint middle = canopy_point(rows, middle_W);
      if (area_m2 > 0.0) {
        take({middle.row, middle.lateral_m >= 0.0 ? 1 : -1,
              static_cast<int>(std::floor(middle.along_m / step_m)),
              static_cast<int>(std::floor(middle.height_m / band_m)), area_m2, middle_W});
      }
      return;
    }
    const CanopyPoint ab = canopy_point(rows, 0.5 * (a.p_W + b.p_W));
    const CanopyPoint bc = canopy_point(rows, 0.5 * (b.p_W + c.p_W));
    const CanopyPoint ca = canopy_point(rows, 0.5 * (c.p_W + a.p_W));
    divide(a, ab, ca);
    divide(ab, b, bc);
    divide(ca, bc, c);
    divide(ab, bc, ca);
  }

  void cut_linear(const CanopyPoint& a, const CanopyPoint& b, const CanopyPoint& c) const {
    Piece whole, right, left;
    whole.add(a), whole.add(b), whole.add(c);
    cut_piece(whole, &CanopyPoint::lateral_m, 0.0, right, left);
    // What lies in the plane of the row's line is in both halves.
    if (a.lateral_m == 0.0 && b.lateral_m == 0.0 && c.lateral_m == 0.0) right.count = 0;
    for (const int side : {1, -1}) {
      const Piece& half = side > 0 ? left : right;
      if (half.count < 3) continue;
      cut_into_strips(half, &CanopyPoint::along_m, step_m, [&](const Piece& strip, int along) {
        cut_into_strips(strip, &CanopyPoint::height_m, band_m, [&](const Piece& piece, int band) {
          hand_over(piece, side, along, band, take);
        });
      });
    }
  }
};

}  // namespace

CanopyPoint canopy_point(const RowLines& rows, const Vector3d& p_W) {
  const RowPlace at = rows.nearest(p_W.head<2>());
  return {p_W, at.row, at.along_m, at.lateral_m, p_W.z() - at.ground_m};
}

void cut_canopy_triangle(const RowLines& rows, const CanopyPoint& a, const CanopyPoint& b,
                         const CanopyPoint& c, double step_m, double band_m,
                         const std::function<void(const CanopyPiece&)>& take) {
  Cutter{rows, step_m, band_m, take}.divide(a, b, c);
}

}  // namespace vinerow::vehicles
