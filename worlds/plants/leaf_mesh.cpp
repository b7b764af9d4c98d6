#include "worlds/plants/leaf_mesh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <span>

#include "engine/api/mesh.h"

namespace vinerow::worlds {

using Eigen::Vector3d;

namespace {

/// Narrow blades bend less: two triangles side by side would be folded instead.
double bend_of(LeafKind kind) {
  return kind == LeafKind::kGrapevine ? 0.18 : kind == LeafKind::kApple ? 0.12 : 0.04;
}

}  // namespace

void append_blade(TriangleMesh& mesh, LeafKind kind, const LeafOrgan& leaf, double area_m2,
                  int level, double widening) {
  const std::span<const Eigen::Vector2d> outline = leaf_outline(kind, level);
  const double length_m = leaf_length_m(kind, area_m2 / widening, level);
  const Vector3d across = leaf.normal.cross(leaf.along);
  // The blade is bent: heights over its plane per length, of the rim at this distance.
  const auto point = [&](const Eigen::Vector2d& p) {
    const double fold = 0.22 * std::abs(p.y()), bend = bend_of(kind) * p.squaredNorm();
    return Vector3d(leaf.junction + length_m * (p.x() * leaf.along + widening * p.y() * across +
                                                (fold - bend) * leaf.normal));
  };
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto add = [&](const Vector3d& p, const Vector3d& normal) {
    mesh.vertices.push_back(p.cast<float>());
    mesh.normals.push_back(normal.cast<float>());
    mesh.colours.push_back(leaf.colour);
  };
  add(leaf.junction, leaf.normal);
  for (const Eigen::Vector2d& p : outline) {
    const Vector3d tilt = 2.0 * bend_of(kind) * (p.x() * leaf.along + p.y() / widening * across) -
                          0.22 * std::copysign(1.0, p.y()) / widening * across;
    add(point(p), (leaf.normal + tilt).normalized());
  }
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i == open_edge(count)) continue;
    mesh.triangles.push_back({first, first + 1 + i, first + 1 + (i + 1) % count});
  }
}

}  // namespace vinerow::worlds
