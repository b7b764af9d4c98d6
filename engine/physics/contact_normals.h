#pragma once
/// Filter for contact points that no real surface has ("ghost collisions" at edges inside a
/// surface).
///
/// The narrow phase considers one triangle at a time. A body that slides over a flat floor hits the
/// edge of the next triangle and gets a normal that opposes its motion. A normal is possible only
/// between the normals of the faces that meet at the point: along the face inside a triangle and at
/// flat or concave edges, up to the bend angle at convex edges. Points with other normals are
/// dropped (the neighbouring triangle reports the true one). Normals that deviate by no more than
/// the narrow phase's noise are set to the face normal.
///
/// Cost: three bytes per triangle of the meshes that were in a contact, computed at the first; then
/// no heap. Nothing for height fields.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "engine/api/forward.h"
#include "engine/physics/lazy.h"

namespace vinerow::physics {

/// Bend angle of the surface at each edge of a triangle (edge k: corner k to k + 1), in units of pi
/// / 127: positive if convex as seen from the front, negative if concave.
using EdgeBends = std::vector<std::array<std::int8_t, 3>>;
constexpr std::int8_t kOpenEdge = 127;  ///< no neighbour, or more than one

/// Corners at the same position count as one, which files of unconnected triangles need.
EdgeBends find_edge_bends(const TriangleMesh& mesh);

class ContactNormals {
 public:
  /// @param world  checked; outlives this object
  explicit ContactNormals(const WorldModel& world);

  /// Computes the bends of all meshes now.
  void prepare() const;

  /// @param user_index  of the static object (static_geometry.h)
  /// @param triangle    of its mesh; unused for the height field
  /// @param p_W,normal_W  point on the static surface; unit, away from it
  /// @param distance_m  < 0: overlapping. Deep overlaps are never dropped.
  /// @returns the normal to use, or nullopt if the point is to be dropped
  std::optional<Eigen::Vector3d> correct(int user_index, int triangle, const Eigen::Vector3d& p_W,
                                         const Eigen::Vector3d& normal_W, double distance_m) const;

 private:
  std::optional<Eigen::Vector3d> correct_on_terrain(const Eigen::Vector3d& p_W,
                                                    const Eigen::Vector3d& normal_W,
                                                    double distance_m) const;
  std::optional<Eigen::Vector3d> correct_on_mesh(int mesh_index, int triangle,
                                                 const Eigen::Vector3d& p_W,
                                                 const Eigen::Vector3d& normal_W,
                                                 double distance_m) const;

  const WorldModel& world_;
  std::map<const TriangleMesh*, Lazy<EdgeBends>> bends_;
  std::vector<const Lazy<EdgeBends>*> bends_of_instance_;
};

}  // namespace vinerow::physics
