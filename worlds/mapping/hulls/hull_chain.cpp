#include "worlds/mapping/hulls/hull_chain.h"

#include <array>
#include <cmath>

#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow::mapping {

HullDirections::HullDirections(std::vector<double> angles_rad)
    : angles_rad_(std::move(angles_rad)) {
  const std::size_t n = angles_rad_.size();
  VINEROW_DEMAND(n >= 3);
  std::vector<double> turns(n);
  for (std::size_t k = 0; k < n; ++k) {
    normals_.emplace_back(std::cos(angles_rad_[k]), std::sin(angles_rad_[k]));
    turns[k] = k + 1 < n ? angles_rad_[k + 1] - angles_rad_[k]
                         : angles_rad_[0] + 2.0 * kPi - angles_rad_[k];
    VINEROW_DEMAND(turns[k] > 1e-6 && turns[k] < kPi - 1e-6);
    inverse_sin_.push_back(1.0 / std::sin(turns[k]));
  }
  for (std::size_t k = 0; k < n; ++k) {
    const double before_rad = turns[(k + n - 1) % n];
    shrink_.push_back(1.0 / std::tan(before_rad) + 1.0 / std::tan(turns[k]));
  }
}

double HullDirections::area_m2(const double* h) const {
  double twice_m2 = 0.0;
  for (int k = 0; k < count(); ++k) twice_m2 += h[k] * side_m(h, k);
  return 0.5 * twice_m2;
}

Eigen::Vector2d HullDirections::corner(const double* h, int k) const {
  const int next = behind(k);
  const Eigen::Vector2d &a = normals_[k], &b = normals_[next];
  return inverse_sin_[k] *
         Eigen::Vector2d(h[k] * b.y() - h[next] * a.y(), h[next] * a.x() - h[k] * b.x());
}

void HullDirections::repair(double* h, double min_m) const {
  // A side beyond the corner of its neighbours moves in to it, which changes nothing. A few rounds,
  // since that shortens the neighbours.
  for (int pass = 0; pass < 4; ++pass) {
    bool whole = true;
    for (int k = 0; k < count(); ++k) {
      const double lacks_m = min_m - side_m(h, k);
      if (lacks_m <= 1e-12) continue;
      whole = false;
      if (shrink_[k] > 1e-3) h[k] -= lacks_m / shrink_[k];
    }
    if (whole) return;
  }
  // Then part of a polygon around a circle, whose sides are long, since side lengths are linear in
  // h. Its middle is that of the corners, or what is nearest to one.
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double radius_m = 2.0 * min_m;
  for (int k = 0; k < count(); ++k) middle += corner(h, k) / count();
  for (int k = 0; k < count(); ++k) {
    radius_m = std::max(radius_m, std::abs(h[k] - normals_[k].dot(middle)));
  }
  double part = 0.0;
  std::vector<double> round(count());
  for (int k = 0; k < count(); ++k) round[k] = normals_[k].dot(middle) + radius_m;
  while (true) {
    double shortest_m = 2.0 * min_m;
    for (int k = 0; k < count(); ++k) {
      shortest_m = std::min(shortest_m, side_m(round.data(), k));
    }
    if (shortest_m >= 2.0 * min_m) break;
    for (int k = 0; k < count(); ++k) round[k] += radius_m;
  }
  for (int k = 0; k < count(); ++k) {
    const double own_m = side_m(h, k);
    if (own_m < min_m) {
      part = std::max(part, (min_m - own_m) / (side_m(round.data(), k) - own_m));
    }
  }
  for (int k = 0; k < count(); ++k) h[k] += part * (round[k] - h[k]);
}

double volume_m3(const HullChain& chain) {
  // The area is quadratic in h and h linear in s: Simpson's rule is exact.
  const int c = chain.directions.count();
  std::vector<double> middle(c);
  double volume = 0.0;
  for (int j = 0; j + 1 < chain.sections(); ++j) {
    const double *a = chain.section(j), *b = chain.section(j + 1);
    for (int k = 0; k < c; ++k) middle[k] = 0.5 * (a[k] + b[k]);
    volume += (chain.s_m[j + 1] - chain.s_m[j]) / 6.0 *
              (chain.directions.area_m2(a) + 4.0 * chain.directions.area_m2(middle.data()) +
               chain.directions.area_m2(b));
  }
  return volume;
}

TriangleMesh make_chain_mesh(const HullChain& chain, const RowCurve& row,
                             const GroundHeight& ground) {
  VINEROW_DEMAND(chain.sections() >= 2);
  TriangleMesh mesh;
  const auto ring = static_cast<std::uint32_t>(chain.directions.count());
  const auto last = static_cast<std::uint32_t>(chain.sections() - 1) * ring;
  mesh.vertices.reserve(last + ring);
  mesh.triangles.reserve(2 * last + 2 * (ring - 2));
  for (int j = 0; j < chain.sections(); ++j) {
    const Eigen::Vector2d middle = row.point_W(chain.s_m[j]);
    const Eigen::Vector2d ahead = row.direction_W(chain.s_m[j]);
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    const double ground_m = ground(middle.x(), middle.y());
    for (int k = 0; k < chain.directions.count(); ++k) {
      const Eigen::Vector2d corner = chain.directions.corner(chain.section(j), k);
      const Eigen::Vector2d p = middle + corner.x() * left;
      mesh.vertices.push_back(Eigen::Vector3d(p.x(), p.y(), ground_m + corner.y()).cast<float>());
    }
  }
  for (std::uint32_t first = 0; first < last; first += ring) {
    for (std::uint32_t k = 0; k < ring; ++k) {
      const std::uint32_t a = first + k, b = first + (k + 1) % ring;
      mesh.triangles.push_back({a, b, b + ring});
      mesh.triangles.push_back({a, b + ring, a + ring});
    }
  }
  for (std::uint32_t k = 1; k + 1 < ring; ++k) {
    mesh.triangles.push_back({0, k + 1, k});
    mesh.triangles.push_back({last, last + k, last + k + 1});
  }
  return mesh;
}

std::int64_t ply_bytes(int corners, int sections) {
  // 12 bytes a vertex, 13 a face.
  const std::int64_t c = corners, n = sections;
  return n < 2 ? 0 : 12 * c * n + 13 * (2 * c * (n - 1) + 2 * (c - 2));
}

}  // namespace vinerow::mapping
