#include "engine/physics/mesh_gate.h"

namespace vinerow::physics {
namespace {

/// Chosen: with fewer shapes the narrow phase itself is not more expensive.
constexpr int kMinShapes = 3;

struct AnyTriangle : btTriangleCallback {
  bool found = false;
  void processTriangle(btVector3* /*corners*/, int /*part*/, int /*triangle*/) override {
    found = true;
  }
};

}  // namespace

bool is_clear_of_mesh(const btCollisionObject& mesh, const btCollisionObject& body,
                      double margin_m) {
  const btCollisionShape& shape = *body.getCollisionShape();
  if (mesh.getCollisionShape()->getShapeType() != TRIANGLE_MESH_SHAPE_PROXYTYPE ||
      !shape.isCompound() ||
      static_cast<const btCompoundShape&>(shape).getNumChildShapes() < kMinShapes) {
    return false;
  }
  btVector3 low, high;
  shape.getAabb(mesh.getWorldTransform().inverse() * body.getWorldTransform(), low, high);
  const btVector3 margin(margin_m, margin_m, margin_m);
  AnyTriangle any;
  static_cast<const btBvhTriangleMeshShape*>(mesh.getCollisionShape())
      ->processAllTriangles(&any, low - margin, high + margin);
  return !any.found;
}

}  // namespace vinerow::physics
