#pragma once
/// The world's terrain and rigid meshes as Bullet collision objects. Only used inside this folder.

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
/// trees are new memory. Instances of one mesh share its tree.
class StaticGeometry {
 public:
  /// @param world  checked; outlives this object
  explicit StaticGeometry(const WorldModel& world);

  const std::vector<std::unique_ptr<btCollisionObject>>& objects() const { return objects_; }

 private:
  struct MeshShape {
    std::unique_ptr<btTriangleIndexVertexArray> arrays;
    std::unique_ptr<btBvhTriangleMeshShape> shape;
  };
  void add_terrain(const HeightField& field);
  void add_object(btCollisionShape& shape, const btTransform& X_WM, int user_index);
  MeshShape make_mesh_shape(const TriangleMesh& mesh);

  std::unique_ptr<btHeightfieldTerrainShape> terrain_;
  std::map<const TriangleMesh*, MeshShape> meshes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
};

}  // namespace vinerow::physics
