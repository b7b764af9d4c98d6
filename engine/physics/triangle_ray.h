#pragma once
/// Watertight intersection of a ray and a triangle in double precision: no ray passes between two
/// triangles that share an edge.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>

#include "engine/physics/triangle_blocks.h"
#include "engine/physics/vector4.h"

namespace vinerow::physics {

/// A ray prepared for many triangles (Woop, Benthin, Wald: Watertight Ray/Triangle Intersection,
/// Journal of Computer Graphics Techniques 2 (2013)).
///
/// The axes are permuted so that the ray runs mostly along the third one, and sheared so that it
/// runs along it alone: p' = (p_x - S_x p_z, p_y - S_y p_z) of p, a point relative to the ray's
/// start. The ray meets the triangle if the plane's origin is on one side of all three edges of
/// (a', b', c'). For an edge that two triangles share, both compute the same two products, one with
/// the opposite sign, so that at least one of them is hit. That holds because no product is fused
/// with the difference (-ffp-contract=off).
class TriangleRay {
 public:
  TriangleRay() = default;  ///< of no ray
  /// @param dir_M  unit
  VINEROW_ALWAYS_INLINE TriangleRay(const Eigen::Vector3d& p_M, const Eigen::Vector3d& dir_M) {
    const double x = std::abs(dir_M.x()), y = std::abs(dir_M.y()), z = std::abs(dir_M.z());
    z_ = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
    x_ = z_ == 2 ? 0 : z_ + 1;
    y_ = z_ == 0 ? 2 : z_ - 1;
    start_ = {p_M[x_], p_M[y_], p_M[z_]};
    scale_ = 1.0 / dir_M[z_];
    shear_x_ = dir_M[x_] * scale_;
    shear_y_ = dir_M[y_] * scale_;
  }

  /// Distance to the triangle, hit from either side, edges included; nullopt if it is behind the
  /// start. @tparam Vector  of three float or double
  template <class Vector>
  std::optional<double> distance_m(const Vector& a_M, const Vector& b_M, const Vector& c_M) const {
    const std::array<double, 3> a = sheared(a_M), b = sheared(b_M), c = sheared(c_M);
    // Twice the signed areas of the triangles formed by the ray and each edge.
    const double u = c[0] * b[1] - c[1] * b[0];
    const double v = a[0] * c[1] - a[1] * c[0];
    const double w = b[0] * a[1] - b[1] * a[0];
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return std::nullopt;
    const double sum = u + v + w;
    if (sum == 0.0) return std::nullopt;  // the ray is in the triangle's plane
    const double t_m = (u * a[2] + v * b[2] + w * c[2]) * scale_ / sum;
    if (!(t_m >= 0.0)) return std::nullopt;
    return t_m;
  }

  /// distance_m() of the triangles of a block: the same operations, four at a time.
  /// @param t_m  distances to those that are met
  /// @returns bit i: the ray meets triangle i of the block
  VINEROW_ALWAYS_INLINE unsigned distances_m(const TriangleBlock& block,
                                             double (&t_m)[TriangleBlock::kSize]) const {
    Double4 p[3][3];  // sheared, [corner][axis]
    for (int corner = 0; corner < 3; ++corner) {
      const auto& q_M = block.corners_M[corner];
      Double4 x, y, z;
      load4(q_M[x_], x);
      load4(q_M[y_], y);
      load4(q_M[z_], z);
      p[corner][2] = z - start_[2];
      p[corner][0] = (x - start_[0]) - shear_x_ * p[corner][2];
      p[corner][1] = (y - start_[1]) - shear_y_ * p[corner][2];
    }
    const auto& [a, b, c] = p;
    const Double4 u = c[0] * b[1] - c[1] * b[0];
    const Double4 v = a[0] * c[1] - a[1] * c[0];
    const Double4 w = b[0] * a[1] - b[1] * a[0];
    const Double4 sum = u + v + w;
    const Mask4 is_out = ((u < 0.0) | (v < 0.0) | (w < 0.0)) & ((u > 0.0) | (v > 0.0) | (w > 0.0));
    const unsigned through = bits_of(~is_out & (sum != 0.0));
    if (through == 0) return 0;
    const Double4 t = (u * a[2] + v * b[2] + w * c[2]) * scale_ / sum;
    store4(t, t_m);
    return through & bits_of(t >= 0.0);
  }

 private:
  template <class Vector>
  std::array<double, 3> sheared(const Vector& q_M) const {
    const double x = q_M[x_] - start_[0], y = q_M[y_] - start_[1], z = q_M[z_] - start_[2];
    return {x - shear_x_ * z, y - shear_y_ * z, z};
  }

  std::array<double, 3> start_;  ///< in the permuted axes
  int x_, y_, z_;
  double scale_, shear_x_, shear_y_;
};

}  // namespace vinerow::physics
