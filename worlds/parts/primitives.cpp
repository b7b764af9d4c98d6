#include "worlds/parts/primitives.h"

#include <array>
#include <cmath>

#include "engine/api/mesh.h"
#include "engine/core/check.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::worlds {

Eigen::Vector3d random_direction(RandomStream& random) {
  const double z = random.uniform(-1.0, 1.0), azimuth = random.uniform(0.0, 2.0 * kPi);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

Eigen::Vector3d any_orthogonal(const Eigen::Vector3d& unit) {
  const Eigen::Vector3d helper =
      std::abs(unit.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  return unit.cross(helper).normalized();
}

void append_tube(TriangleMesh& mesh, std::span<const TubePoint> points, int sides,
                 const Eigen::Vector3f& colour) {
  VINEROW_DEMAND(points.size() >= 2 && sides >= 3);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto n = static_cast<std::uint32_t>(sides);
  const auto rings = static_cast<std::uint32_t>(points.size());
  Eigen::Vector3d across = any_orthogonal((points[1].p - points[0].p).normalized());
  const auto add = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
    mesh.vertices.push_back(p.cast<float>());
    mesh.normals.push_back(normal.cast<float>());
    mesh.colours.push_back(colour);
  };
  for (std::uint32_t r = 0; r < rings; ++r) {
    const Eigen::Vector3d before = points[r == 0 ? 0 : r - 1].p;
    const Eigen::Vector3d after = points[r + 1 == rings ? r : r + 1].p;
    const Eigen::Vector3d along = (after - before).normalized();
    // The ring's zero direction is carried along, so that the tube does not twist.
    across = (across - across.dot(along) * along).normalized();
    const Eigen::Vector3d other = along.cross(across);
    for (std::uint32_t k = 0; k < n; ++k) {
      const double angle = 2.0 * kPi * k / n;
      const Eigen::Vector3d out = std::cos(angle) * across + std::sin(angle) * other;
      add(points[r].p + points[r].radius_m * out, out);
    }
  }
  for (std::uint32_t r = 0; r + 1 < rings; ++r) {
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = first + r * n + k, b = first + r * n + (k + 1) % n;
      mesh.triangles.push_back({a, b, b + n});
      mesh.triangles.push_back({a, b + n, a + n});
    }
  }
  const auto cap = [&](std::uint32_t ring, bool at_end) {
    const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
    const std::uint32_t neighbour = at_end ? ring - 1 : ring + 1;
    add(points[ring].p, (points[ring].p - points[neighbour].p).normalized());
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = first + ring * n + k, b = first + ring * n + (k + 1) % n;
      if (at_end) {
        mesh.triangles.push_back({centre, a, b});
      } else {
        mesh.triangles.push_back({centre, b, a});
      }
    }
  };
  cap(0, false);
  cap(rings - 1, true);
}

void append_sphere(TriangleMesh& mesh, const Eigen::Vector3d& centre, double radius_m,
                   const Eigen::Vector3f& colour) {
  static const double kPhi = (1.0 + std::sqrt(5.0)) / 2.0;
  static const std::array<Eigen::Vector3d, 12> kCorners = {
      Eigen::Vector3d(-1, kPhi, 0),  Eigen::Vector3d(1, kPhi, 0),   Eigen::Vector3d(-1, -kPhi, 0),
      Eigen::Vector3d(1, -kPhi, 0),  Eigen::Vector3d(0, -1, kPhi),  Eigen::Vector3d(0, 1, kPhi),
      Eigen::Vector3d(0, -1, -kPhi), Eigen::Vector3d(0, 1, -kPhi),  Eigen::Vector3d(kPhi, 0, -1),
      Eigen::Vector3d(kPhi, 0, 1),   Eigen::Vector3d(-kPhi, 0, -1), Eigen::Vector3d(-kPhi, 0, 1)};
  // By fours that lie close together, in whose boxes rays search for them.
  static constexpr std::uint8_t kFaces[20][3] = {
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},   {0, 7, 10},  //
      {0, 10, 11}, {5, 11, 4}, {11, 10, 2}, {2, 4, 11},  //
      {1, 5, 9},   {7, 1, 8},  {4, 9, 5},   {9, 8, 1},   //
      {10, 7, 6},  {3, 2, 6},  {6, 2, 10},  {8, 6, 7},   //
      {3, 9, 4},   {3, 4, 2},  {3, 6, 8},   {3, 8, 9}};
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3d& corner : kCorners) {
    const Eigen::Vector3d out = corner.normalized();
    mesh.vertices.push_back((centre + radius_m * out).cast<float>());
    mesh.normals.push_back(out.cast<float>());
    mesh.colours.push_back(colour);
  }
  for (const auto& face : kFaces) {
    mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
  }
}

void append_card(TriangleMesh& mesh, const LeafCard& card) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const Eigen::Vector3d corners[4] = {card.stem - card.side, card.stem + card.side,
                                      card.tip + card.side, card.tip - card.side};
  constexpr float kUv[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int k = 0; k < 4; ++k) {
    mesh.vertices.push_back(corners[k].cast<float>());
    mesh.normals.push_back(card.normal.cast<float>());
    mesh.uvs.emplace_back(kUv[k][0], kUv[k][1]);
    mesh.colours.push_back(card.colour);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

void calc_vertex_normals(TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> sums(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
    const Eigen::Vector3d area = (b - a).cross(c - a);
    for (const std::uint32_t v : t) sums[v] += area;
  }
  mesh.normals.clear();
  for (const Eigen::Vector3d& sum : sums) {
    const double length = sum.norm();
    mesh.normals.push_back(length > 0.0 ? Eigen::Vector3f((sum / length).cast<float>())
                                        : Eigen::Vector3f::UnitZ());
  }
}

}  // namespace vinerow::worlds
