#include "engine/physics/contact_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "engine/api/height_field.h"
#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "engine/math/pose.h"
#include "engine/physics/check_world.h"

namespace vinerow::physics {
namespace {

using Eigen::Vector3d;

// Chosen: the narrow phase's normals scatter by about this angle.
constexpr double kNoise_rad = 0.01;
// Chosen: a contact point nearer to an edge counts as on the edge.
constexpr double kEdge_m = 1e-3;
// Chosen: deeper overlaps are real, whatever their normal.
constexpr double kDeep_m = 2e-3;
constexpr double kBendUnit_rad = kPi / kOpenEdge;

/// Half-edge of a triangle, for matching.
struct HalfEdge {
  std::uint32_t low, high;  // welded corners
  std::uint32_t triangle;
  std::uint8_t edge;
  bool upwards;  // direction from low to high
};

/// For each vertex the first vertex at the same position.
std::vector<std::uint32_t> weld(const std::vector<Eigen::Vector3f>& vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) {
    return std::tuple(vertices[v].x(), vertices[v].y(), vertices[v].z());
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple_cat(key(a), std::tuple(a)) < std::tuple_cat(key(b), std::tuple(b));
  });
  std::vector<std::uint32_t> first(vertices.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && key(order[k]) == key(order[k - 1]);
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  return first;
}

Vector3d corner(const TriangleMesh& mesh, std::uint32_t triangle, int k) {
  return mesh.vertices[mesh.triangles[triangle][k % 3]].cast<double>();
}

Vector3d face_normal(const TriangleMesh& mesh, std::uint32_t triangle) {
  const Vector3d a = corner(mesh, triangle, 0);
  return (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a).normalized();
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Bend of the surface at half-edge `half`, given the neighbour's half-edge.
std::int8_t calc_bend(const TriangleMesh& mesh, const HalfEdge& half, const HalfEdge& other) {
  const Vector3d normal = face_normal(mesh, half.triangle);
  // Neighbours with the same direction of the shared edge have opposite windings.
  const Vector3d other_normal =
      face_normal(mesh, other.triangle) * (half.upwards == other.upwards ? -1.0 : 1.0);
  if (!normal.allFinite() || !other_normal.allFinite()) return kOpenEdge;
  const Vector3d across =
      corner(mesh, other.triangle, other.edge + 2) - corner(mesh, half.triangle, 0);
  const double bend = std::ceil(angle_between(normal, other_normal) / kBendUnit_rad - 0.1);
  const double bounded = std::min(bend, kOpenEdge - 1.0);
  // The neighbour's far corner is behind the face: convex.
  return static_cast<std::int8_t>(across.dot(normal) < 0.0 ? bounded : -bounded);
}

/// Rule of the header for a point at which the surface may lean up to `max_rad` from `face`.
std::optional<Vector3d> judge_normal(const Vector3d& normal, const Vector3d& face, double max_rad) {
  const double lean_rad = angle_between(normal, face);
  if (lean_rad <= kNoise_rad) return face;
  if (lean_rad <= max_rad + kNoise_rad) return normal;
  return std::nullopt;
}

}  // namespace

EdgeBends find_edge_bends(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> first = weld(mesh.vertices);
  std::vector<HalfEdge> halves;
  halves.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = first[mesh.triangles[t][k]];
      const std::uint32_t b = first[mesh.triangles[t][(k + 1) % 3]];
      halves.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t),
                        static_cast<std::uint8_t>(k), a < b});
    }
  }
  std::sort(halves.begin(), halves.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.triangle, a.edge) <
           std::tie(b.low, b.high, b.triangle, b.edge);
  });
  EdgeBends bends(mesh.triangles.size(), {kOpenEdge, kOpenEdge, kOpenEdge});
  for (std::size_t begin = 0; begin < halves.size();) {
    std::size_t end = begin;
    while (end < halves.size() && halves[end].low == halves[begin].low &&
           halves[end].high == halves[begin].high) {
      ++end;
    }
    if (end - begin == 2) {
      const HalfEdge& a = halves[begin];
      const HalfEdge& b = halves[begin + 1];
      bends[a.triangle][a.edge] = calc_bend(mesh, a, b);
      bends[b.triangle][b.edge] = calc_bend(mesh, b, a);
    }
    begin = end;
  }
  return bends;
}

ContactNormals::ContactNormals(const WorldModel& world) : world_(world) {
  bends_of_instance_.assign(world.meshes.size(), nullptr);
  for (std::size_t i = 0; i < world.meshes.size(); ++i) {
    const MeshInstance& instance = world.meshes[i];
    if (!is_rigid(instance)) continue;
    const TriangleMesh* mesh = instance.mesh.get();
    const auto bends = bends_.try_emplace(mesh, [mesh] { return find_edge_bends(*mesh); }).first;
    bends_of_instance_[i] = &bends->second;
  }
}

void ContactNormals::prepare() const {
  for (const auto& [mesh, bends] : bends_) bends.get();
}

std::optional<Vector3d> ContactNormals::correct(int user_index, int triangle, const Vector3d& p_W,
                                                const Vector3d& normal_W, double distance_m) const {
  return user_index < 0 ? correct_on_terrain(p_W, normal_W, distance_m)
                        : correct_on_mesh(user_index, triangle, p_W, normal_W, distance_m);
}

std::optional<Vector3d> ContactNormals::correct_on_terrain(const Vector3d& p_W,
                                                           const Vector3d& normal_W,
                                                           double distance_m) const {
  const HeightField& field = *world_.terrain;
  Vector3d face_W = field.normal_W(p_W.x(), p_W.y());
  if (angle_between(normal_W, face_W) <= kNoise_rad) return face_W;

  // Faces that meet at the point: those at eight positions around it.
  constexpr int kAround = 8;
  constexpr double kDiagonal = 0.70710678118654752;
  constexpr double kX[kAround] = {1, kDiagonal, 0, -kDiagonal, -1, -kDiagonal, 0, kDiagonal};
  std::array<Vector3d, kAround> faces_W;
  for (int k = 0; k < kAround; ++k) {
    const double x = p_W.x() + kEdge_m * kX[k];
    const double y = p_W.y() + kEdge_m * kX[(k + 6) % kAround];
    faces_W[k] = field.normal_W(x, y);
    if (faces_W[k].dot(normal_W) > face_W.dot(normal_W)) face_W = faces_W[k];
  }
  double max_rad = 0.0;
  const double height_m = field.height_m(p_W.x(), p_W.y());
  for (int k = 0; k < kAround; ++k) {
    const Eigen::Vector2d offset(kEdge_m * kX[k], kEdge_m * kX[(k + 6) % kAround]);
    const double rise_m = field.height_m(p_W.x() + offset.x(), p_W.y() + offset.y()) - height_m;
    const double plane_m = -face_W.head<2>().dot(offset) / face_W.z();
    const bool is_ridge = rise_m < plane_m - 1e-9;
    if (is_ridge) max_rad = std::max(max_rad, angle_between(faces_W[k], face_W));
  }
  const std::optional<Vector3d> judged = judge_normal(normal_W, face_W, max_rad);
  return judged || distance_m > -kDeep_m ? judged : face_W;
}

std::optional<Vector3d> ContactNormals::correct_on_mesh(int mesh_index, int triangle,
                                                        const Vector3d& p_W,
                                                        const Vector3d& normal_W,
                                                        double distance_m) const {
  const EdgeBends& bends = bends_of_instance_[mesh_index]->get();
  if (triangle < 0 || triangle >= static_cast<int>(bends.size())) return normal_W;
  const MeshInstance& instance = world_.meshes[mesh_index];
  const TriangleMesh& mesh = *instance.mesh;
  const Vector3d face_M = face_normal(mesh, triangle);
  if (!face_M.allFinite()) return normal_W;
  const Pose X_MW = instance.X_WM.inverse();
  const Vector3d p_M = X_MW * p_W;
  const Vector3d normal_M = X_MW.q * normal_W;
  const double towards = face_M.dot(normal_M) >= 0.0 ? 1.0 : -1.0;
  for (const double side : {towards, -towards}) {
    double max_rad = 0.0;
    for (int k = 0; k < 3; ++k) {
      const Vector3d a = corner(mesh, triangle, k);
      const Vector3d along = (corner(mesh, triangle, k + 1) - a).normalized();
      if ((p_M - a).cross(along).squaredNorm() > kEdge_m * kEdge_m) continue;
      const int bend = bends[triangle][k];
      const double out = bend == kOpenEdge ? bend : side * bend;
      max_rad = std::max(max_rad, out * kBendUnit_rad);
    }
    if (const auto judged = judge_normal(normal_M, side * face_M, max_rad)) {
      return Vector3d(instance.X_WM.q * *judged);
    }
  }
  if (distance_m > -kDeep_m) return std::nullopt;
  return Vector3d(instance.X_WM.q * (towards * face_M));
}

}  // namespace vinerow::physics
