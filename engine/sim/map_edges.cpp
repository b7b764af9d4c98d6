#include "engine/sim/map_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "engine/api/map.h"
#include "engine/api/mesh.h"

namespace vinerow {
namespace {

/// Cosine of the angle between the normals of two triangles up to which they form a quad, 45 deg.
constexpr double kMinCosine = 0.7071;

/// Positions of both ends, the lexicographically smaller one first.
using Edge = std::array<float, 6>;

Edge edge_between(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const std::array<float, 3> p{a.x(), a.y(), a.z()}, q{b.x(), b.y(), b.z()};
  const auto& [low, high] = std::minmax(p, q);
  return {low[0], low[1], low[2], high[0], high[1], high[2]};
}

Eigen::Vector3d low_end(const Edge& edge) {
  return Eigen::Vector3f(edge[0], edge[1], edge[2]).cast<double>();
}
Eigen::Vector3d high_end(const Edge& edge) {
  return Eigen::Vector3f(edge[3], edge[4], edge[5]).cast<double>();
}

/// Properties of the triangles at an edge.
struct Sides {
  int triangles = 0;
  int longest_of = 0;       ///< number of them in which it is the longest edge
  Eigen::Vector3d first_n;  ///< normals of the first and the last of them
  Eigen::Vector3d last_n;

  bool is_diagonal() const {
    return triangles == 2 && longest_of == 2 && first_n.dot(last_n) > kMinCosine;
  }
};

void add_edges(const TriangleMesh& mesh, LineList& lines) {
  std::map<Edge, Sides> sides_of;
  std::vector<Edge> in_order;
  for (const auto& triangle : mesh.triangles) {
    std::array<Edge, 3> edges;
    std::array<double, 3> lengths;
    for (int k = 0; k < 3; ++k) {
      edges[k] = edge_between(mesh.vertices[triangle[k]], mesh.vertices[triangle[(k + 1) % 3]]);
      lengths[k] = (high_end(edges[k]) - low_end(edges[k])).norm();
    }
    const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double>();
    const Eigen::Vector3d n = (mesh.vertices[triangle[1]].cast<double>() - a)
                                  .cross(mesh.vertices[triangle[2]].cast<double>() - a)
                                  .normalized();
    for (int k = 0; k < 3; ++k) {
      const auto [found, is_new] = sides_of.try_emplace(edges[k]);
      if (is_new) in_order.push_back(edges[k]);
      Sides& sides = found->second;
      if (is_new) sides.first_n = n;
      sides.last_n = n;
      ++sides.triangles;
      const bool is_longest =
          lengths[k] > lengths[(k + 1) % 3] && lengths[k] > lengths[(k + 2) % 3];
      sides.longest_of += is_longest;
    }
  }
  for (const Edge& edge : in_order) {
    if (sides_of.at(edge).is_diagonal()) continue;
    lines.points_W.push_back(low_end(edge));
    lines.points_W.push_back(high_end(edge));
  }
}

}  // namespace

LineList map_edges(const RowMap& map) {
  LineList lines;
  for (const RowMesh& mesh : map.meshes) add_edges(mesh.mesh_W, lines);
  return lines;
}

}  // namespace vinerow
