#include "engine/physics/static_geometry.h"

#include <algorithm>

#include "engine/api/height_field.h"
#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/physics/bullet_convert.h"
#include "engine/physics/check_world.h"
#include "engine/physics/lazy.h"

namespace vinerow::physics {
namespace {

// Bullet enlarges concave shapes by their margin (4 cm by default), which would lift everything off
// the ground. The bodies' own margins keep the narrow phase well conditioned.
constexpr double kStaticMargin_m = 0.0;
// Largest number of triangles that the node index of the quantized tree can address.
constexpr std::size_t kMaxQuantizedTriangles = 2'000'000;

/// Builds Bullet's tree when a body first comes near the mesh. Bullet's own ray casts would find no
/// tree; this program casts rays by Embree.
class MeshShape final : public btBvhTriangleMeshShape {
 public:
  MeshShape(btStridingMeshInterface* mesh, bool is_quantized)
      : btBvhTriangleMeshShape(mesh, is_quantized, false), tree_([this] {
          buildOptimizedBvh();
          return true;
        }) {}

  void prepare() const { tree_.get(); }

  void processAllTriangles(btTriangleCallback* callback, const btVector3& low,
                           const btVector3& high) const override {
    prepare();
    btBvhTriangleMeshShape::processAllTriangles(callback, low, high);
  }

 private:
  Lazy<bool> tree_;
};

}  // namespace

StaticGeometry::StaticGeometry(const WorldModel& world) {
  if (world.terrain) add_terrain(*world.terrain);
  for (std::size_t i = 0; i < world.meshes.size(); ++i) {
    const MeshInstance& instance = world.meshes[i];
    if (!is_rigid(instance)) continue;
    auto found = meshes_.find(instance.mesh.get());
    if (found == meshes_.end()) {
      found = meshes_.emplace(instance.mesh.get(), make_mesh_shape(*instance.mesh)).first;
    }
    places_.push_back({found->second.shape.get(), to_bullet(instance.X_WM), static_cast<int>(i)});
  }
}

void StaticGeometry::add_terrain(const HeightField& field) {
  const auto [low, high] = std::minmax_element(field.heights_m.begin(), field.heights_m.end());
  constexpr int kUpAxis = 2;
  // Without flipping, Bullet splits a cell along the other diagonal than HeightField.
  constexpr bool kFlipQuadEdges = true;
  terrain_ = std::make_unique<btHeightfieldTerrainShape>(
      field.columns, field.rows, field.heights_m.data(), *low, *high, kUpAxis, kFlipQuadEdges);
  terrain_->setLocalScaling({field.cell_m, field.cell_m, 1.0});
  terrain_->setMargin(kStaticMargin_m);
  // Bullet places the middle of the grid and of the height range at the shape's origin.
  const btVector3 origin(field.corner_W.x() + 0.5 * field.width_m(),
                         field.corner_W.y() + 0.5 * field.depth_m(),
                         0.5 * (static_cast<double>(*low) + static_cast<double>(*high)));
  places_.push_back(
      {terrain_.get(), btTransform(btQuaternion::getIdentity(), origin), kTerrainIndex});
}

void StaticGeometry::prepare() const {
  for (const auto& [mesh, shared] : meshes_) {
    static_cast<const MeshShape&>(*shared.shape).prepare();
  }
}

std::vector<std::unique_ptr<btCollisionObject>> StaticGeometry::make_objects() const {
  std::vector<std::unique_ptr<btCollisionObject>> objects;
  objects.reserve(places_.size());
  for (const Place& place : places_) {
    auto object = std::make_unique<btCollisionObject>();
    object->setCollisionShape(place.shape);
    object->setWorldTransform(place.X_WM);
    object->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
    object->setUserIndex(place.user_index);
    // A contact's coefficient is the product of both sides: 1 keeps the body's own.
    object->setFriction(1.0);
    object->setRestitution(1.0);
    objects.push_back(std::move(object));
  }
  return objects;
}

StaticGeometry::SharedShape StaticGeometry::make_mesh_shape(const TriangleMesh& mesh) {
  btIndexedMesh part;
  part.m_numTriangles = static_cast<int>(mesh.triangles.size());
  part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(mesh.triangles.data());
  part.m_triangleIndexStride = sizeof(mesh.triangles[0]);
  part.m_numVertices = static_cast<int>(mesh.vertices.size());
  part.m_vertexBase = reinterpret_cast<const unsigned char*>(mesh.vertices.data());
  part.m_vertexStride = sizeof(Eigen::Vector3f);
  part.m_indexType = PHY_INTEGER;
  part.m_vertexType = PHY_FLOAT;
  SharedShape result;
  result.arrays = std::make_unique<btTriangleIndexVertexArray>();
  result.arrays->addIndexedMesh(part, PHY_INTEGER);
  // addIndexedMesh assumes the library's precision for the vertices.
  result.arrays->getIndexedMeshArray()[0].m_vertexType = PHY_FLOAT;
  // Otherwise Bullet goes over all triangles six times for it.
  const Eigen::AlignedBox3d bounds = mesh.bounds();
  result.arrays->setPremadeAabb(to_bullet(Eigen::Vector3d(bounds.min())),
                                to_bullet(Eigen::Vector3d(bounds.max())));
  const bool quantized = mesh.triangles.size() <= kMaxQuantizedTriangles;
  result.shape = std::make_unique<MeshShape>(result.arrays.get(), quantized);
  result.shape->setMargin(kStaticMargin_m);
  return result;
}

}  // namespace vinerow::physics
