#pragma once
/// The world's terrain and rigid meshes as Bullet shapes. Only used inside this folder.

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <btBulletCollisionCommon.h>

#include <map>
#include <memory>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::physics {

/// User index of the height field's collision object; a mesh has its index in WorldModel::meshes.
constexpr int kTerrainIndex = -1;

/// Heights, vertices and triangles are referenced where the WorldModel holds them; only Bullet's
/// trees are new memory. Instances of one mesh share its tree. Shapes do not change while bodies
/// move, so that several collision worlds can share them, on several threads too.
class StaticGeometry {
 public:
  /// @param world  checked; outlives this object
  explicit StaticGeometry(const WorldModel& world);

  /// Collision objects that stand on these shapes, for one collision world alone: its broad phase
  /// keeps its notes in them. The height field comes first, then meshes in the world's order.
  std::vector<std::unique_ptr<btCollisionObject>> make_objects() const;

 private:
  struct Place {
    btCollisionShape* shape;
    btTransform X_WM;
    int user_index;
  };
  struct MeshShape {
    std::unique_ptr<btTriangleIndexVertexArray> arrays;
    std::unique_ptr<btBvhTriangleMeshShape> shape;
  };
  void add_terrain(const HeightField& field);
  MeshShape make_mesh_shape(const TriangleMesh& mesh);

  std::unique_ptr<btHeightfieldTerrainShape> terrain_;
  std::map<const TriangleMesh*, MeshShape> meshes_;
  std::vector<Place> places_;
};

}  // namespace vinerow::physics
