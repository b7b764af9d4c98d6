#pragma once
/// Terrain and rigid meshes of a world as Bullet shapes. Only used inside this folder.

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <btBulletCollisionCommon.h>

#include <map>
#include <memory>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::physics {

/// User index of the height field's collision object; a mesh has its index in WorldModel::meshes.
constexpr int kTerrainIndex = -1;

/// Heights, vertices and triangles are referenced in the WorldModel; only Bullet's trees use new
/// memory. Instances of one mesh share its tree, which is built when a body first comes near one of
/// them. The shapes are constant while bodies move, so
/// several collision worlds can share them, also on several threads.
class StaticGeometry {
 public:
  /// @param world  checked; outlives this object
  explicit StaticGeometry(const WorldModel& world);

  /// Builds all trees now.
  void prepare() const;

  /// New collision objects on these shapes, for a single collision world, because its broad phase
  /// stores data in them. The height field comes first, then meshes in the world's order.
  std::vector<std::unique_ptr<btCollisionObject>> make_objects() const;

 private:
  struct Place {
    btCollisionShape* shape;
    btTransform X_WM;
    int user_index;
  };
  struct SharedShape {
    std::unique_ptr<btTriangleIndexVertexArray> arrays;
    std::unique_ptr<btBvhTriangleMeshShape> shape;
  };
  void add_terrain(const HeightField& field);
  SharedShape make_mesh_shape(const TriangleMesh& mesh);

  std::unique_ptr<btHeightfieldTerrainShape> terrain_;
  std::map<const TriangleMesh*, SharedShape> meshes_;
  std::vector<Place> places_;
};

}  // namespace vinerow::physics
