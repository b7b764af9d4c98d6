#include "engine/io/meshes/polygon_triangles.h"

#include <Eigen/Geometry>
#include <cmath>

#include "engine/core/check.h"

namespace vinerow::io {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Corners projected to the plane normal to the mean normal (Newell's method), counter-clockwise.
std::vector<Vector2d> flatten(const std::vector<Eigen::Vector3f>& vertices,
                              std::span<const std::uint32_t> polygon) {
  Vector3d normal = Vector3d::Zero();
  const Vector3d origin = vertices[polygon[0]].cast<double>();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector3d a = vertices[polygon[k]].cast<double>() - origin;
    const Vector3d b = vertices[polygon[(k + 1) % polygon.size()]].cast<double>() - origin;
    normal += a.cross(b);
  }
  // The axis closest to the plane keeps the projection well conditioned.
  int axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  const Vector3d x = normal.cross(Vector3d::Unit(axis)).normalized();
  const Vector3d y = normal.normalized().cross(x);
  std::vector<Vector2d> flat;
  flat.reserve(polygon.size());
  for (const std::uint32_t v : polygon) {
    const Vector3d p = vertices[v].cast<double>() - origin;
    flat.emplace_back(p.dot(x), p.dot(y));
  }
  return flat;
}

bool is_inside(const Vector2d& p, const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return cross(b - a, p - a) >= 0.0 && cross(c - b, p - b) >= 0.0 && cross(a - c, p - c) >= 0.0;
}

}  // namespace

void triangulate_polygon(const std::vector<Eigen::Vector3f>& vertices,
                         std::span<const std::uint32_t> polygon,
                         std::vector<std::array<std::uint32_t, 3>>& triangles) {
  VINEROW_DEMAND(polygon.size() >= 3);
  if (polygon.size() == 3) {
    triangles.push_back({polygon[0], polygon[1], polygon[2]});
    return;
  }
  const std::vector<Vector2d> p = flatten(vertices, polygon);
  std::vector<std::size_t> left(polygon.size());
  for (std::size_t k = 0; k < left.size(); ++k) left[k] = k;
  const auto turn_at = [&](std::size_t k) {
    const std::size_t n = left.size();
    const Vector2d &a = p[left[(k + n - 1) % n]], &b = p[left[k]], &c = p[left[(k + 1) % n]];
    return cross(b - a, c - b);
  };
  const auto is_convex = [&] {
    for (std::size_t k = 0; k < left.size(); ++k) {
      if (!(turn_at(k) >= 0.0)) return false;
    }
    return true;
  };
  const auto is_ear = [&](std::size_t k) {
    if (!(turn_at(k) > 0.0)) return false;
    const std::size_t n = left.size();
    const std::size_t before = (k + n - 1) % n, after = (k + 1) % n;
    for (std::size_t other = 0; other < n; ++other) {
      if (other == before || other == k || other == after) continue;
      const Vector2d& q = p[left[other]];
      if (q == p[left[before]] || q == p[left[k]] || q == p[left[after]]) continue;
      if (is_inside(q, p[left[before]], p[left[k]], p[left[after]])) return false;
    }
    return true;
  };
  while (left.size() > 3 && !is_convex()) {
    std::size_t ear = 0;
    while (ear < left.size() && !is_ear(ear)) ++ear;
    if (ear == left.size()) break;
    const std::size_t n = left.size();
    triangles.push_back(
        {polygon[left[(ear + n - 1) % n]], polygon[left[ear]], polygon[left[(ear + 1) % n]]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  for (std::size_t k = 1; k + 1 < left.size(); ++k) {
    triangles.push_back({polygon[left[0]], polygon[left[k]], polygon[left[k + 1]]});
  }
}

}  // namespace vinerow::io
