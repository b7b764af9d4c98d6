#include "engine/physics/mesh_gate.h"

#include <LinearMath/btAabbUtil2.h>

namespace vinerow::physics {
namespace {

/// Whether a triangle's bounding box in the body's axes meets that of the body. A vehicle seldom
/// drives along the mesh's axes, and its box along those is then longer and wider than itself.
struct NearTriangle : btTriangleCallback {
  btTransform X_BM;
  btVector3 low_B, high_B;
  bool found = false;

  void processTriangle(btVector3* corners_M, int /*part*/, int /*triangle*/) override {
    if (found) return;
    btVector3 low = X_BM * corners_M[0], high = low;
    for (int i = 1; i < 3; ++i) {
      const btVector3 corner = X_BM * corners_M[i];
      low.setMin(corner);
      high.setMax(corner);
    }
    found = TestAabbAgainstAabb2(low, high, low_B, high_B);
  }
};

}  // namespace

bool is_clear_of_mesh(const btCollisionObject& mesh, const btCollisionObject& body,
                      double margin_m) {
  const btCollisionShape& shape = *body.getCollisionShape();
  if (mesh.getCollisionShape()->getShapeType() != TRIANGLE_MESH_SHAPE_PROXYTYPE ||
      !shape.isCompound()) {
    return false;
  }
  const btVector3 margin(margin_m, margin_m, margin_m);
  const btTransform X_MB = mesh.getWorldTransform().inverse() * body.getWorldTransform();
  btVector3 low_M, high_M;
  shape.getAabb(X_MB, low_M, high_M);
  NearTriangle near;
  near.X_BM = X_MB.inverse();
  shape.getAabb(btTransform::getIdentity(), near.low_B, near.high_B);
  near.low_B -= margin;
  near.high_B += margin;
  static_cast<const btBvhTriangleMeshShape*>(mesh.getCollisionShape())
      ->processAllTriangles(&near, low_M - margin, high_M + margin);
  return !near.found;
}

}  // namespace vinerow::physics
