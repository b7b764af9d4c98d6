#include "engine/physics/mesh_gate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vinerow::physics {
namespace {

/// A search looks this much further than the margin. More saves searches, but each finds more
/// triangles, in vain where one is near.
constexpr double kReach_m = 0.3;
constexpr double kReachNearMesh_m = 0.03;

using Triangle = std::array<btVector3, 3>;

/// Gap of a triangle and a box along an axis; < 0 if they overlap there.
double gap_along_m(const btVector3& axis, const Triangle& triangle, const AxisBox& box) {
  const auto [low, high] =
      std::minmax({axis.dot(triangle[0]), axis.dot(triangle[1]), axis.dot(triangle[2])});
  const double middle = axis.dot(box.low + box.high) / 2.0;
  const double half = axis.absolute().dot(box.high - box.low) / 2.0;
  return std::max(low - middle - half, middle - half - high);
}

/// The same along the box's own axes, where it is cheap.
double box_gap_m(const Triangle& triangle, const AxisBox& box) {
  btVector3 low = triangle[0], high = triangle[0];
  for (int i = 1; i < 3; ++i) {
    low.setMin(triangle[i]);
    high.setMax(triangle[i]);
  }
  btVector3 gap = low - box.high;
  gap.setMax(box.low - high);
  return gap[gap.maxAxis()];
}

/// Largest gap along the 13 axes of the separating axis theorem: those of the box, the triangle's
/// normal, and the products of their edges. It is at most the distance of the two, and < 0 only if
/// they overlap. A wire's triangles are as long as a row: along the axes of a vehicle that does not
/// drive along it, their bounding boxes cover the alley.
double gap_m(const Triangle& triangle, const AxisBox& box) {
  double largest = box_gap_m(triangle, box);
  const auto consider = [&](const btVector3& axis) {
    const double length2 = axis.length2();
    if (length2 > 1e-12) {  // edges in parallel otherwise: another axis separates these
      largest = std::max(largest, gap_along_m(axis / std::sqrt(length2), triangle, box));
    }
  };
  consider((triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]));
  for (int i = 0; i < 3; ++i) {
    const btVector3 edge = triangle[(i + 1) % 3] - triangle[i];
    consider({0.0, -edge.z(), edge.y()});  // x axis times edge, and so on
    consider({edge.z(), 0.0, -edge.x()});
    consider({-edge.y(), edge.x(), 0.0});
  }
  return largest;
}

/// Finds the least gap between the body and a triangle, in the body's axes. A vehicle seldom drives
/// along the mesh's axes, and its box along those is longer and wider than itself. A triangle
/// within the margin of the body's box is compared with the boxes of its shapes.
struct NearestTriangle : btTriangleCallback {
  btTransform X_BM;
  AxisBox body_B;
  const btCompoundShape* compound;  ///< null: the body has a single shape
  std::vector<AxisBox>* shapes_B;   ///< empty until needed
  double margin_m = 0.0;
  double distance_m = 0.0;

  void processTriangle(btVector3* corners_M, int /*part*/, int /*triangle*/) override {
    const Triangle triangle{X_BM * corners_M[0], X_BM * corners_M[1], X_BM * corners_M[2]};
    if (box_gap_m(triangle, body_B) >= distance_m) return;
    double gap = gap_m(triangle, body_B);
    if (gap <= margin_m && compound) gap = shapes_gap_m(triangle);
    distance_m = std::min(distance_m, gap);
  }

 private:
  double shapes_gap_m(const Triangle& triangle) {
    if (shapes_B->empty()) {
      shapes_B->resize(static_cast<std::size_t>(compound->getNumChildShapes()));
      for (int i = 0; i < compound->getNumChildShapes(); ++i) {
        AxisBox& box = (*shapes_B)[static_cast<std::size_t>(i)];
        compound->getChildShape(i)->getAabb(compound->getChildTransform(i), box.low, box.high);
      }
    }
    double least = std::numeric_limits<double>::infinity();
    for (const AxisBox& shape : *shapes_B) least = std::min(least, gap_m(triangle, shape));
    return least;
  }
};

/// Upper bound of the distance that a point within `radius_m` of the origin moves between two
/// poses:
/// |(R1 - R0) p + t1 - t0| <= |R1 - R0|_F |p| + |t1 - t0|.
double bound_motion_m(const btTransform& from, const btTransform& to, double radius_m) {
  double turned2 = 0.0;
  for (int i = 0; i < 3; ++i) turned2 += (to.getBasis()[i] - from.getBasis()[i]).length2();
  return std::sqrt(turned2) * radius_m + (to.getOrigin() - from.getOrigin()).length();
}

}  // namespace

void MeshGate::follow(const btCollisionObject& body) {
  const auto index = static_cast<std::size_t>(body.getUserIndex2());
  if (index >= bodies_.size()) bodies_.resize(index + 1);
  Followed& followed = bodies_[index];
  if (followed.radius_m < 0.0) {
    AxisBox box_B;
    body.getCollisionShape()->getAabb(btTransform::getIdentity(), box_B.low, box_B.high);
    btVector3 farthest = box_B.low.absolute();
    farthest.setMax(box_B.high.absolute());
    followed.radius_m = farthest.length();
  } else {
    followed.travelled_m +=
        bound_motion_m(followed.X_WB, body.getWorldTransform(), followed.radius_m);
  }
  followed.X_WB = body.getWorldTransform();
}

bool MeshGate::is_clear(const btCollisionObject& mesh, const btCollisionObject& body,
                        double margin_m) {
  Followed& followed = bodies_[static_cast<std::size_t>(body.getUserIndex2())];
  const auto place = static_cast<std::size_t>(mesh.getWorldArrayIndex());
  if (place >= followed.clear_until_m.size()) followed.clear_until_m.resize(place + 1, 0.0);
  double& clear_until_m = followed.clear_until_m[place];
  if (followed.travelled_m < clear_until_m) return true;

  const btCollisionShape& shape = *body.getCollisionShape();
  if (mesh.getCollisionShape()->getShapeType() != TRIANGLE_MESH_SHAPE_PROXYTYPE ||
      !(shape.isCompound() || shape.isConvex())) {
    return false;
  }

  // The tree of the mesh is searched along its own axes.
  const double wide_m = margin_m + (clear_until_m > 0.0 ? kReach_m : kReachNearMesh_m);
  const btVector3 wide(wide_m, wide_m, wide_m);
  const btTransform& X_WB = followed.X_WB;
  const btTransform X_MB = mesh.getWorldTransform().inverse() * X_WB;
  btVector3 low_M, high_M;
  shape.getAabb(X_MB, low_M, high_M);
  shapes_B_.clear();
  NearestTriangle nearest;
  nearest.X_BM = X_MB.inverse();
  shape.getAabb(btTransform::getIdentity(), nearest.body_B.low, nearest.body_B.high);
  nearest.compound = shape.isCompound() ? static_cast<const btCompoundShape*>(&shape) : nullptr;
  nearest.shapes_B = &shapes_B_;
  nearest.margin_m = margin_m;
  nearest.distance_m = wide_m;
  static_cast<const btBvhTriangleMeshShape*>(mesh.getCollisionShape())
      ->processAllTriangles(&nearest, low_M - wide, high_M + wide);

  const double free_m = nearest.distance_m - margin_m;
  clear_until_m = free_m > 0.0 ? followed.travelled_m + free_m : 0.0;
  return free_m > 0.0;
}

}  // namespace vinerow::physics
