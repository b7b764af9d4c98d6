#pragma once
/// Ray casting and plane cuts on the row meshes of a map, for estimators that predict range
/// readings.
///
/// Facets are listed by the squares of a grid over east and north. A ray walks the squares below it
/// (Amanatides and Woo, "A fast voxel traversal algorithm for ray tracing", Eurographics 1987) and
/// so tests some tens of facets, whatever the size of the map. Rows may bend or cross. This
/// replaces the moving window of paper C, section 3.2, and its cut into segments: a plane cut with
/// rays in the plane gives the same distances as rays against the facets (to 4e-13 m,
/// tests/controllers/estimation).

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::controllers {

class RowMeshIndex {
 public:
  struct Hit {
    double distance_m = 0.0;
    Eigen::Vector3d normal_W = Eigen::Vector3d::UnitX();  ///< N, unit, towards the ray's origin
    double plane_m = 0.0;                                 ///< D of the facet's plane N.x = D
    int row = -1;                                         ///< PlantRow::id
    int facet = -1;  ///< number among all triangles of the map's meshes, in their order
  };

  /// A segment of a cut, in W. Seen against the plane's normal, the plants are to its left.
  struct Segment {
    Eigen::Vector3d from_W, to_W;
    Eigen::Vector3d normal_W;  ///< of the facet, outwards
    int row = -1;
  };

  /// @param cell_m  side of the grid's squares, > 0; enlarged if the map would need more than four
  /// million squares
  /// @throws ConfigError "the map has no row meshes ..." if all meshes are empty; one sentence with
  /// row and triangle if a mesh is not well formed
  explicit RowMeshIndex(const RowMap& map, double cell_m = 0.5);

  /// First facet that faces the ray. A ray that starts inside the plants hits the next row. No
  /// heap, thread safe. @param dir_W unit @returns nullopt if the ray hits nothing within that
  /// distance or is not finite
  std::optional<Hit> cast_ray(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                              double max_distance_m) const;

  /// Slice of paper C, eq. 5-6: the segments in which the plane n.x = n.p cuts the facets. Returns
  /// all segments that come within `radius_m` of p, seen from above, at full length. Neighbouring
  /// facets share their end points to the bit. Clears `segments`; allocates only beyond their
  /// capacity.
  /// @param normal_W  unit, of the plane
  void cut(const Eigen::Vector3d& p_W, const Eigen::Vector3d& normal_W, double radius_m,
           std::vector<Segment>& segments) const;

 private:
  /// Fills one cache line. The corners are the map's own bits.
  struct alignas(64) Facet {
    Eigen::Vector3d normal;  // unit; zero: no area, in no list
    Eigen::Vector3f a, b, c;
    std::int32_t row;
  };
  /// A grid square.
  struct Square {
    int i, j;
  };

  void read_facets(const RowMap& map);
  void lay_grid(double cell_m);
  void list_facets();
  Square square_at(double x, double y) const;
  std::size_t index_of(Square square) const {
    return static_cast<std::size_t>(square.j) * columns_ + square.i;
  }
  /// Calls visit(square) for each square below the facet.
  template <class Visit>
  void for_each_square_below(const Facet& facet, Visit&& visit) const;

  std::vector<Facet> facets_;
  int columns_ = 0, lines_ = 0;
  double cell_m_ = 0.5;
  Eigen::Vector2d low_ = {0, 0}, high_ = {0, 0};  // corners of the grid
  double facet_reach_m_ = 0.0;  // largest distance of a corner from the facet's centre, from above
  std::vector<std::uint32_t> first_;  // start of each square's list, and the end
  // Facets; the highest bit is set in the square that the facet's centre is in.
  std::vector<std::uint32_t> listed_;
};

}  // namespace vinerow::controllers
