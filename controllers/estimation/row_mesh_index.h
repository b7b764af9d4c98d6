#pragma once
/// Rays against the row meshes of a map, for estimators: what a range sensor should read at a pose.
///
/// Only what lies near is looked at: triangles are kept by row and by stretches along the row, so
/// that a ray tests some tens of them however large the map is. This is the moving window of paper
/// C, section 3.2, without its cut into segments: a plane cut and rays in the plane give the same
/// distances as rays against the triangles (to 4e-13 m, tests/controllers/estimation).

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "engine/api/map.h"

namespace vinerow {

class RowMeshIndex {
 public:
  struct Hit {
    double distance_m = 0.0;
    Eigen::Vector3d normal_W = Eigen::Vector3d::UnitX();  ///< N, unit, towards the ray's origin
    double plane_m = 0.0;                                 ///< D of the facet's plane N.x = D
    int row = -1;                                         ///< PlantRow::id
    int facet = -1;                                       ///< of all facets of the map
  };

  /// A segment of a cut, in W.
  struct Segment {
    Eigen::Vector3d from_W, to_W;
    Eigen::Vector3d normal_W;  ///< of the facet, outwards
    int row = -1;
  };

  /// @param stretch_m  length of the stretches that facets are kept by
  /// @throws ConfigError "the map has no row meshes ..." if there are none
  explicit RowMeshIndex(const RowMap& map, double stretch_m = 1.0);

  /// First facet that faces the ray. No heap, thread safe. @param dir_W  unit
  std::optional<Hit> cast_ray(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                              double max_distance_m) const;

  /// Where the plane n.x = n.p cuts the facets within `radius_m` of p, seen from above: the slice
  /// of paper C, eq. 5-6. Clears `segments`; allocates only beyond their capacity.
  /// @param normal_W  unit, of the plane
  void cut(const Eigen::Vector3d& p_W, const Eigen::Vector3d& normal_W, double radius_m,
           std::vector<Segment>& segments) const;

  /// Of everything that is kept.
  std::size_t memory_bytes() const;
  int facet_count() const;
};

}  // namespace vinerow
