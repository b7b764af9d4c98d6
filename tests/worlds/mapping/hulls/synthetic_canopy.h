#pragma once
/// Canopy points of known shapes, as a survey from above sees them.

#include <functional>

#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "worlds/mapping/hulls/hull_figures.h"
#include "worlds/mapping/rows/row_canopy.h"
#include "worlds/parts/canopy.h"

namespace vinerow::test {

/// Corners of a section, counter-clockwise in the (y, z) plane, at s.
using SectionAt = std::function<std::vector<Eigen::Vector2d>(double s_m)>;

struct Sampling {
  double per_m2 = 1500.0;   ///< on level surfaces
  double side_share = 1.0;  ///< on upright ones
  double noise_m = 0.0;     ///< 1 sigma, each axis
  bool underside = true;    ///< seen
};

/// The surface from one s to another as triangles, caps included, in (s, y, z).
inline TriangleMesh surface_of(const SectionAt& section, double from_m, double to_m,
                               double step_m) {
  TriangleMesh mesh;
  const int steps = std::max(1, static_cast<int>(std::lround((to_m - from_m) / step_m)));
  std::uint32_t ring = 0;
  for (int i = 0; i <= steps; ++i) {
    const double s_m = from_m + (to_m - from_m) * i / steps;
    const auto corners = section(s_m);
    ring = static_cast<std::uint32_t>(corners.size());
    for (const Eigen::Vector2d& p : corners) {
      mesh.vertices.push_back(Eigen::Vector3d(s_m, p.x(), p.y()).cast<float>());
    }
  }
  const auto last = static_cast<std::uint32_t>(steps) * ring;
  for (std::uint32_t first = 0; first < last; first += ring) {
    for (std::uint32_t k = 0; k < ring; ++k) {
      const std::uint32_t a = first + k, b = first + (k + 1) % ring;
      mesh.triangles.push_back({a, b, b + ring});
      mesh.triangles.push_back({a, b + ring, a + ring});
    }
  }
  for (std::uint32_t k = 1; k + 1 < ring; ++k) {
    mesh.triangles.push_back({0, k + 1, k});
    mesh.triangles.push_back({last, last + k, last + k + 1});
  }
  return mesh;
}

/// Adds points evenly spread over a closed mesh in (s, y, z).
inline void sample(const TriangleMesh& mesh, const Sampling& sampling, RandomStream& random,
                   std::vector<Eigen::Vector3f>& points) {
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d ab = mesh.vertices[t[1]].cast<double>() - a;
    const Eigen::Vector3d ac = mesh.vertices[t[2]].cast<double>() - a;
    const Eigen::Vector3d n = ab.cross(ac);
    if (n.norm() < 1e-12) continue;
    const double up = n.z() / n.norm();
    if (up < -0.3 && !sampling.underside) continue;
    const double wanted =
        0.5 * n.norm() * sampling.per_m2 * std::max(std::abs(up), sampling.side_share);
    const int count = static_cast<int>(wanted + random.uniform());
    for (int i = 0; i < count; ++i) {
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      Eigen::Vector3d p = a + u * ab + v * ac;
      for (int axis = 0; axis < 3; ++axis) p[axis] += sampling.noise_m * random.normal();
      points.push_back(p.cast<float>());
    }
  }
}

inline SectionAt box(double width_m, double base_m, double top_m) {
  return [=](double) {
    return std::vector<Eigen::Vector2d>{{0.5 * width_m, base_m},
                                        {0.5 * width_m, top_m},
                                        {-0.5 * width_m, top_m},
                                        {-0.5 * width_m, base_m}};
  };
}

/// 96 corners on the ellipse around (0, middle) scaled by `scale(s)`.
inline SectionAt ellipse(double half_width_m, double half_height_m, double middle_m,
                         std::function<double(double)> scale) {
  return [=](double s_m) {
    std::vector<Eigen::Vector2d> corners;
    for (int k = 0; k < 96; ++k) {
      const double angle = 2.0 * kPi * k / 96;
      corners.emplace_back(scale(s_m) * half_width_m * std::cos(angle),
                           middle_m + scale(s_m) * half_height_m * std::sin(angle));
    }
    return corners;
  };
}

struct VineRow {
  mapping::RowCanopy canopy;
  double volume_m3 = 0.0;  ///< of the mesh that was sampled
};

/// The canopy of a simulated row: vines that differ, lumps, rounded ends, sides seen with 0.4 of
/// the density and no underside.
inline VineRow vine_row(int row, double length_m, Sampling sampling) {
  const mapping::RowCurve line({Eigen::Vector2d(0, 0), Eigen::Vector2d(length_m, 0)});
  const worlds::CanopyParams params;
  RandomStream shape_random(8, "", std::to_string(row)), random(7, "", std::to_string(row));
  const worlds::CanopyShape shape(params, length_m, static_cast<int>(length_m / 0.9), shape_random);
  const TriangleMesh mesh = worlds::make_canopy_hull(
      line, [](double, double) { return 0.0; }, {{0.0, length_m, &shape}}, params);
  VineRow result{{row, line, {}}, mapping::mesh_volume_m3(mesh)};
  sampling.side_share = 0.4;
  sampling.underside = false;
  sample(mesh, sampling, random, result.canopy.points);
  return result;
}

}  // namespace vinerow::test
