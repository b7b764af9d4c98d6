#include "engine/physics/winding.h"

#include <Eigen/Geometry>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::physics {

using Eigen::Vector3d;

/// tan(angle / 2) = a . (b x c) / (|a||b||c| + (a . b)|c| + (b . c)|a| + (c . a)|b|)
/// for the corners a, b, c as seen from the point.
double calc_winding(const TriangleMesh& mesh, const Vector3d& p_M) {
  double half_angles = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const Vector3d a = mesh.vertices[triangle[0]].cast<double>() - p_M;
    const Vector3d b = mesh.vertices[triangle[1]].cast<double>() - p_M;
    const Vector3d c = mesh.vertices[triangle[2]].cast<double>() - p_M;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    half_angles +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angles / (2.0 * kPi);
}

}  // namespace vinerow::physics
