#pragma once
/// Figures of a row's hulls: points inside, widths and heights, volume.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "worlds/mapping/hulls/hull_chain.h"

namespace vinerow::mapping {

/// Exact test for points inside hulls or at most a distance outside their surface.
///
/// Most points need c comparisons. A point inside the section at its s is inside; a point within
/// the distance of that section, in its plane, is near enough; a point farther above it than the
/// steepest side nearby allows is outside. Only the remaining points are measured against
/// triangles.
class HullContainment {
 public:
  /// @param chains  of one row, in order, not overlapping along it; must outlive this object
  HullContainment(const std::vector<HullChain>& chains, double tolerance_m);

  /// @param p  (s, y, z)
  bool contains(const Eigen::Vector3d& p) const;
  std::int64_t count(const std::vector<Eigen::Vector3f>& points) const;

 private:
  struct Interval {
    const HullChain* chain;
    int section;      ///< first section of the interval
    double steepest;  ///< |dh/ds| of it and of those within the tolerance
  };
  bool contains_near(const Interval& interval, const Eigen::Vector3d& p) const;

  double tolerance_m_;
  std::vector<Interval> intervals_;
  double low_m_ = 0.0;
  std::vector<std::uint32_t> starts_;  // first interval that ends behind each step along the row
};

/// Distance from p to the triangle. Source: C. Ericson, "Real-time collision detection",
/// 2005, 5.1.5.
double distance_to_triangle_m(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                              const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Signed volume of a closed mesh by the divergence theorem, positive if triangles are
/// counter-clockwise seen from outside.
double mesh_volume_m3(const TriangleMesh& mesh);

/// Means along the chains, m.
struct SectionMeans {
  double base_m = 0.0, top_m = 0.0, width_m = 0.0, length_m = 0.0;
};
SectionMeans mean_sections(const std::vector<HullChain>& chains);

}  // namespace vinerow::mapping
