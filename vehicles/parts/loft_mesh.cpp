#include "vehicles/parts/loft_mesh.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector3d;

/// Sum of the normals of the faces around each point, by their areas.
LoftRows sum_normals(const LoftRows& rows, std::size_t columns, double side) {
  const std::size_t points = rows.front().size();
  LoftRows normals(rows.size(), std::vector<Vector3d>(points, Vector3d::Zero()));
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      const std::size_t k = (j + 1) % points;
      const Vector3d face = side * (rows[i + 1][k] - rows[i][j]).cross(rows[i + 1][j] - rows[i][k]);
      for (const auto& [r, c] : {std::pair{i, j}, {i, k}, {i + 1, j}, {i + 1, k}}) {
        normals[r][c] += face;
      }
    }
  }
  return normals;
}

}  // namespace

void append_loft(const LoftRows& rows, const LoftOptions& options, MeshBuilder& builder) {
  const std::size_t points = rows.front().size();
  const std::size_t columns = options.closed ? points : points - 1;
  const LoftRows normals = sum_normals(rows, columns, options.mirrored ? -1.0 : 1.0);
  TriangleMesh skin;
  const auto add = [&](std::size_t i, std::size_t j) {
    skin.vertices.push_back(rows[i][j].cast<float>());
    const Vector3d& n = normals[i][j];
    skin.normals.push_back((n.norm() > 0.0 ? n.normalized() : Vector3d::UnitZ()).cast<float>());
  };
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      const std::size_t k = (j + 1) % points;
      const auto first = static_cast<std::uint32_t>(skin.vertices.size());
      add(i, j), add(i, k), add(i + 1, k), add(i + 1, j);
      if (options.mirrored) {
        skin.triangles.push_back({first, first + 2, first + 1});
        skin.triangles.push_back({first, first + 3, first + 2});
      } else {
        skin.triangles.push_back({first, first + 1, first + 2});
        skin.triangles.push_back({first, first + 2, first + 3});
      }
      if (options.colour) skin.colours.insert(skin.colours.end(), 4, options.colour(i, j));
    }
  }
  builder.append(skin);
}

void append_lid(const std::vector<Vector3d>& row, const Vector3d& outward, MeshBuilder& builder) {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p : row) middle += p / static_cast<double>(row.size());
  for (std::size_t j = 0; j < row.size(); ++j) {
    const Vector3d &a = row[j], &b = row[(j + 1) % row.size()];
    const Vector3d normal = (a - middle).cross(b - middle);
    if (normal.norm() < 1e-12) continue;
    if (normal.dot(outward) > 0.0) {
      builder.triangle(middle, a, b);
    } else {
      builder.triangle(middle, b, a);
    }
  }
}

}  // namespace vinerow::vehicles
