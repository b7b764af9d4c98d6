#pragma once
/// Hull along a row: convex sections whose sides share the same directions, joined by straight
/// lines.
///
/// Frame: (s, y, z) of RowCanopy: along the row's line, to the left, above the ground on the line.
/// A section is the part of the plane at s where n_k . (y, z) <= h_k for every k. Between sections
/// h is linear, and so is every corner: side faces are plane.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "engine/api/mesh.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {

/// Unit vectors (y, z) counter-clockwise (y left, z up), neighbours less than pi apart, with
/// constants that every section needs.
class HullDirections {
 public:
  /// @param angles_rad  3 or more, rising, all turns between neighbours in (0, pi) (demanded)
  explicit HullDirections(std::vector<double> angles_rad);

  int count() const { return static_cast<int>(normals_.size()); }
  const Eigen::Vector2d& normal(int k) const { return normals_[k]; }
  double angle_rad(int k) const { return angles_rad_[k]; }
  int before(int k) const { return k == 0 ? count() - 1 : k - 1; }
  int behind(int k) const { return k + 1 == count() ? 0 : k + 1; }

  /// Length of side k, negative if its neighbours meet inside it.
  /// dl_k/dh_k = -shrink(k), dl_k/dh_neighbour = 1 / sin(turn).
  double side_m(const double* h, int k) const {
    return h[before(k)] * inverse_sin_[before(k)] + h[behind(k)] * inverse_sin_[k] -
           h[k] * shrink_[k];
  }
  double shrink(int k) const { return shrink_[k]; }
  /// 1 / sin of the turn from direction k to the next.
  double inverse_sin(int k) const { return inverse_sin_[k]; }
  /// 1/2 sum h_k l_k. @pre no side is negative
  double area_m2(const double* h) const;
  /// Intersection of sides k and k + 1.
  Eigen::Vector2d corner(const double* h, int k) const;
  /// Ensures that the section has count() corners: moves a side shorter than `min_m` in to the
  /// intersection of its neighbours, and all sides out if nothing is left.
  void repair(double* h, double min_m) const;

 private:
  std::vector<double> angles_rad_;
  std::vector<Eigen::Vector2d> normals_;
  std::vector<double> inverse_sin_;  // of the turn from k to k + 1
  std::vector<double> shrink_;       // cot of the turns before and behind, summed
};

struct HullChain {
  HullDirections directions;
  std::vector<double> s_m;  ///< of the sections, rising, >= 2
  std::vector<double> h_m;  ///< count of directions per section

  int sections() const { return static_cast<int>(s_m.size()); }
  const double* section(int j) const {
    return h_m.data() + static_cast<std::size_t>(j) * directions.count();
  }
  double* section(int j) { return h_m.data() + static_cast<std::size_t>(j) * directions.count(); }
  double from_m() const { return s_m.front(); }
  double to_m() const { return s_m.back(); }
};

/// Volume, exact for a straight row.
double volume_m3(const HullChain& chain);

/// Corners and plane sides in W, capped, 2 c (sections - 1) + 2 (c - 2) triangles.
TriangleMesh make_chain_mesh(const HullChain& chain, const RowCurve& row,
                             const GroundHeight& ground);

/// Bytes of vertices and faces in binary PLY.
std::int64_t ply_bytes(int corners, int sections);

}  // namespace vinerow::mapping
