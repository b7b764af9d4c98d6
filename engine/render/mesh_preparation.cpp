#include "engine/render/mesh_preparation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "engine/api/mesh.h"
#include "engine/render/builtin_textures.h"
#include "engine/render/noise.h"

namespace vinerow::render {

namespace {

/// Linear RGB of leaves without mesh colours.
const Eigen::Vector3f kLeafGreen(0.085f, 0.165f, 0.034f);

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// For each vertex, the first vertex at the same position.
std::vector<std::uint32_t> join_equal_positions(const std::vector<Eigen::Vector3f>& vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    return std::make_tuple(vertices[i].x(), vertices[i].y(), vertices[i].z(), i);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> joined(vertices.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && vertices[order[k]] == vertices[order[k - 1]];
    joined[order[k]] = same ? joined[order[k - 1]] : order[k];
  }
  return joined;
}

bool is_closed(const TriangleMesh& mesh, const Triangles& triangles,
               const std::vector<std::uint32_t>& joined) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Edge> forward;
  std::vector<Edge> backward;
  double volume = 0.0;
  for (const auto& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = joined[t[k]];
      const std::uint32_t b = joined[t[(k + 1) % 3]];
      if (a == b) continue;
      forward.emplace_back(a, b);
      backward.emplace_back(b, a);
    }
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    volume += a.dot(mesh.vertices[t[1]].cast<double>().cross(mesh.vertices[t[2]].cast<double>()));
  }
  std::sort(forward.begin(), forward.end());
  std::sort(backward.begin(), backward.end());
  return volume > 0.0 && forward == backward;
}

void set_normal(GpuVertex& vertex, const Eigen::Vector3f& normal) {
  const float length = normal.norm();
  const Eigen::Vector3f n =
      length > 1e-20f ? Eigen::Vector3f(normal / length) : Eigen::Vector3f::UnitZ();
  for (int c = 0; c < 3; ++c) vertex.normal[c] = static_cast<std::int8_t>(std::lround(n[c] * 127));
  vertex.normal[3] = 0;
}

GpuVertex make_vertex(const TriangleMesh& mesh, std::uint32_t i) {
  GpuVertex vertex{};
  for (int c = 0; c < 3; ++c) vertex.position[c] = mesh.vertices[i][c];
  if (!mesh.uvs.empty()) {
    vertex.uv[0] = mesh.uvs[i].x();
    vertex.uv[1] = mesh.uvs[i].y();
  }
  for (int c = 0; c < 3; ++c) {
    const float v = mesh.colours.empty() ? 1.0f : std::clamp(mesh.colours[i][c], 0.0f, 1.0f);
    vertex.colour[c] = static_cast<std::uint8_t>(std::lround(std::sqrt(v) * 255.0f));
  }
  return vertex;
}

/// One vertex per corner. Its normal is the area-weighted mean of the adjacent faces within 40 deg
/// of the corner's face; equal corners are merged again.
void build_with_creases(const TriangleMesh& mesh, const Triangles& triangles,
                        const std::vector<std::uint32_t>& joined, PreparedMesh& out) {
  std::vector<Eigen::Vector3f> face_normals;  // length = twice the area
  for (const auto& t : triangles) {
    const Eigen::Vector3f a = mesh.vertices[t[0]];
    face_normals.push_back((mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a));
  }
  // Corners grouped by position.
  std::vector<std::uint32_t> corners(triangles.size() * 3);
  std::iota(corners.begin(), corners.end(), 0u);
  const auto place = [&](std::uint32_t corner) {
    return joined[triangles[corner / 3][corner % 3]];
  };
  std::stable_sort(corners.begin(), corners.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
  out.indices.resize(corners.size());
  const float crease = std::cos(40.0f * 3.14159265f / 180.0f);
  for (std::size_t begin = 0; begin < corners.size();) {
    std::size_t end = begin;
    while (end < corners.size() && place(corners[end]) == place(corners[begin])) ++end;
    const std::size_t first_vertex = out.vertices.size();
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f own = face_normals[corners[i] / 3];
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (std::size_t k = begin; k < end; ++k) {
        const Eigen::Vector3f& other = face_normals[corners[k] / 3];
        if (own.dot(other) >= crease * own.norm() * other.norm()) sum += other;
      }
      GpuVertex vertex = make_vertex(mesh, triangles[corners[i] / 3][corners[i] % 3]);
      set_normal(vertex, sum);
      std::size_t same = first_vertex;
      const auto equal = [&](const GpuVertex& v) {
        return std::equal(v.normal, v.normal + 4, vertex.normal) &&
               std::equal(v.uv, v.uv + 2, vertex.uv) &&
               std::equal(v.colour, v.colour + 4, vertex.colour);
      };
      while (same < out.vertices.size() && !equal(out.vertices[same])) ++same;
      if (same == out.vertices.size()) out.vertices.push_back(vertex);
      out.indices[corners[i]] = static_cast<std::uint32_t>(same);
    }
    begin = end;
  }
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Finds the cards (pieces with shared vertices) and gives each a picture for its size, a random
/// reflection and a slightly different tint.
void choose_cards(const TriangleMesh& mesh, const Triangles& triangles, CardKind kind,
                  PreparedMesh& out) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  for (const auto& t : triangles) {
    for (int k = 1; k < 3; ++k) {
      const std::uint32_t a = root_of(parent, t[0]);
      const std::uint32_t b = root_of(parent, t[k]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<double> area(mesh.vertices.size(), 0.0);
  std::vector<double> uv_area(mesh.vertices.size(), 0.0);
  for (const auto& t : triangles) {
    const std::uint32_t root = root_of(parent, t[0]);
    const Eigen::Vector3f a = mesh.vertices[t[0]];
    area[root] += 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
    const Eigen::Vector2f u = mesh.uvs[t[1]] - mesh.uvs[t[0]];
    const Eigen::Vector2f v = mesh.uvs[t[2]] - mesh.uvs[t[0]];
    uv_area[root] += 0.5 * std::abs(u.x() * v.y() - u.y() * v.x());
  }
  const int base = kind == CardKind::kTree ? kLeafLayersPerKind : 0;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    const std::uint32_t root = root_of(parent, i);
    const double edge = std::sqrt(area[root] / std::max(uv_area[root], 1e-9));
    const std::uint32_t hash = hash_cell(root, 3u, 17u);
    int layer = base;
    if (edge < 0.22) {
      layer += kLeafSingle + static_cast<int>(hash % 2u);
    } else if (edge < 0.7) {
      layer += kLeafSpray + static_cast<int>(hash % 3u);
    } else {
      layer += kLeafClump + static_cast<int>(hash % 3u);
    }
    GpuVertex& vertex = out.vertices[i];
    vertex.colour[3] = static_cast<std::uint8_t>(layer);
    if (hash & 64u) vertex.uv[0] = 1.0f - vertex.uv[0];
    if (mesh.colours.empty()) {
      const Eigen::Vector3f own = kLeafGreen * (0.8f + 0.4f * hash01(root, 5u, 17u));
      for (int c = 0; c < 3; ++c) {
        vertex.colour[c] = static_cast<std::uint8_t>(std::lround(std::sqrt(own[c]) * 255.0f));
      }
    }
  }
}

}  // namespace

PreparedMesh prepare_mesh(const TriangleMesh& mesh, CardKind cards) {
  Triangles triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    if (std::max({t[0], t[1], t[2]}) < mesh.vertices.size()) triangles.push_back(t);
  }
  PreparedMesh out;
  out.bounds_M = mesh.bounds();
  const bool has_normals = mesh.normals.size() == mesh.vertices.size();
  if (!has_normals && cards == CardKind::kNone) {
    const std::vector<std::uint32_t> joined = join_equal_positions(mesh.vertices);
    out.closed = is_closed(mesh, triangles, joined);
    build_with_creases(mesh, triangles, joined, out);
    return out;
  }
  if (cards == CardKind::kNone) {
    out.closed = is_closed(mesh, triangles, join_equal_positions(mesh.vertices));
  }
  out.vertices.reserve(mesh.vertices.size());
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    out.vertices.push_back(make_vertex(mesh, i));
    set_normal(out.vertices.back(), has_normals ? mesh.normals[i] : Eigen::Vector3f::UnitZ());
  }
  out.indices.reserve(triangles.size() * 3);
  for (const auto& t : triangles) out.indices.insert(out.indices.end(), t.begin(), t.end());
  if (cards != CardKind::kNone && mesh.uvs.size() == mesh.vertices.size()) {
    choose_cards(mesh, triangles, cards, out);
  }
  return out;
}

}  // namespace vinerow::render
