#pragma once
/// Cheap proof that a body of one convex shape or several (a compound) does not touch a static
/// mesh. The posts of a row are one mesh whose bounding box covers the alleys next to it. The
/// narrow phase would search that mesh's tree for every shape of a vehicle between the rows, and
/// compute the distance of each triangle in a box along the mesh's axes, which is larger than the
/// vehicle.

#include <btBulletCollisionCommon.h>

#include <vector>

namespace vinerow::physics {

/// Box along the axes of a body.
struct AxisBox {
  btVector3 low, high;
};

/// One per collision world. Remembers for each body and mesh how far the body may move before the
/// mesh must be searched again.
class MeshGate {
 public:
  /// Follows a body to its new pose: once per step, before its pairs are asked about.
  /// @param body  with its index as user index 2; of a shape that never changes
  void follow(const btCollisionObject& body);
  /// @param mesh  static, never moved; a static object of another shape is never reported as clear
  /// @param body  followed, convex or compound; another is never clear
  /// @param margin_m  distance to the mesh up to which the body counts as touching; always the same
  /// @returns true if no triangle is within `margin_m` of the body; false if one may be
  bool is_clear(const btCollisionObject& mesh, const btCollisionObject& body, double margin_m);

 private:
  struct Followed {
    btTransform X_WB;          ///< pose of the last step
    double radius_m = -1.0;    ///< of its box's corners, around its origin; < 0: not yet known
    double travelled_m = 0.0;  ///< upper bound of the path of each of its points
    /// By the mesh's place in the collision world: length of path up to which the last search found
    /// it clear; 0: it did not, or there was none.
    std::vector<double> clear_until_m;
  };

  std::vector<Followed> bodies_;   ///< by user index 2
  std::vector<AxisBox> shapes_B_;  ///< scratch: the boxes of the body's shapes, in its axes
};

}  // namespace vinerow::physics
