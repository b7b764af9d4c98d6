#pragma once
/// Cheap proof that a body of one convex shape or several (a compound) does not touch a static
/// mesh. The posts of a row are one mesh whose bounding box covers the alleys next to it. The
/// narrow phase would search that mesh's tree for every shape of a vehicle between the rows, and
/// compute the distance of each triangle in a box along the mesh's axes, which is larger than the
/// vehicle.

#include <btBulletCollisionCommon.h>

#include <unordered_map>
#include <vector>

namespace vinerow::physics {

/// Box along the axes of a body.
struct AxisBox {
  btVector3 low, high;
};

/// One per collision world. Remembers for each mesh and body how far the body may move before the
/// mesh must be searched again.
class MeshGate {
 public:
  /// @param mesh  static, never moved; a static object of another shape is never reported as clear
  /// @param body  of a shape that never changes, convex or compound; another is never clear
  /// @param margin_m  distance to the mesh up to which the body counts as touching; always the same
  /// @returns true if no triangle is within `margin_m` of the body; false if one may be
  bool is_clear(const btCollisionObject& mesh, const btCollisionObject& body, double margin_m);

 private:
  /// The result of a search of the mesh.
  struct Search {
    btTransform X_WB;       ///< pose of the body at the search
    double reach_m = 0.0;   ///< distance that each point of the body may move; <= 0: none
    double radius_m = 0.0;  ///< of the box's corners, around the body's origin
  };
  struct Pair {
    const btCollisionObject* mesh;
    const btCollisionObject* body;
    bool operator==(const Pair&) const = default;
  };
  struct PairHash {
    std::size_t operator()(const Pair& pair) const;
  };

  /// Only looked up, never iterated: the order of addresses has no effect.
  std::unordered_map<Pair, Search, PairHash> searches_;
  std::vector<AxisBox> shapes_B_;  ///< scratch: the boxes of the body's shapes, in its axes
};

}  // namespace vinerow::physics
