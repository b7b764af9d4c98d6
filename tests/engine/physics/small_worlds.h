#pragma once
/// Worlds and meshes of a few triangles for the tests of physics.

#include <cmath>
#include <memory>

#include "engine/api/height_field.h"
#include "engine/api/mesh.h"
#include "engine/core/random.h"
#include "engine/physics/physics_world.h"

namespace vinerow::physics::test {

/// Height field around the origin with heights from `height(x, y)`.
template <class Height>
HeightField make_terrain(int columns, int rows, double cell_m, Height&& height) {
  HeightField field;
  field.columns = columns;
  field.rows = rows;
  field.cell_m = cell_m;
  field.corner_W = {-0.5 * field.width_m(), -0.5 * field.depth_m()};
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double x = field.corner_W.x() + i * cell_m;
      const double y = field.corner_W.y() + j * cell_m;
      field.heights_m.push_back(static_cast<float>(height(x, y)));
    }
  }
  return field;
}

inline HeightField make_hills(int samples = 41, double cell_m = 0.5) {
  return make_terrain(samples, samples, cell_m, [](double x, double y) {
    return 30.0 + 0.8 * std::sin(0.9 * x) * std::cos(0.7 * y) + 0.1 * x;
  });
}

inline HeightField make_flat(double height_m = 0.0, int samples = 41, double cell_m = 0.5) {
  return make_terrain(samples, samples, cell_m, [=](double, double) { return height_m; });
}

/// The height field's triangles as a mesh, in W.
inline std::shared_ptr<TriangleMesh> make_mesh_of(const HeightField& field) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      mesh->vertices.emplace_back(static_cast<float>(field.corner_W.x() + i * field.cell_m),
                                  static_cast<float>(field.corner_W.y() + j * field.cell_m),
                                  field.heights_m[static_cast<std::size_t>(j) * field.columns + i]);
    }
  }
  for (int j = 0; j + 1 < field.rows; ++j) {
    for (int i = 0; i + 1 < field.columns; ++i) {
      const auto a = static_cast<std::uint32_t>(j * field.columns + i);
      const std::uint32_t b = a + 1, c = a + field.columns, d = c + 1;
      mesh->triangles.push_back({a, b, d});
      mesh->triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

/// Box with corners at +-half extents, 12 triangles, seen from outside.
inline std::shared_ptr<TriangleMesh> make_box_mesh(const Eigen::Vector3f& h) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int k = 0; k < 8; ++k) {
    mesh->vertices.emplace_back(k & 1 ? h.x() : -h.x(), k & 2 ? h.y() : -h.y(),
                                k & 4 ? h.z() : -h.z());
  }
  mesh->triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline MeshInstance make_instance(const char* name, std::shared_ptr<const TriangleMesh> mesh,
                                  const Eigen::Vector3d& p_W, SurfaceClass surface) {
  MeshInstance instance;
  instance.name = name;
  instance.mesh = std::move(mesh);
  instance.X_WM.p = p_W;
  instance.surface = surface;
  return instance;
}

inline Eigen::Matrix3d box_inertia(double mass_kg, const Eigen::Vector3d& h) {
  const Eigen::Vector3d s = h.cwiseAbs2();
  return Eigen::Vector3d(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()).asDiagonal() *
         Eigen::Matrix3d(Eigen::Matrix3d::Identity() * (mass_kg / 3.0));
}

inline BodySpec make_box(const Eigen::Vector3d& half_extents_m, double mass_kg,
                         const Eigen::Vector3d& p_W) {
  BodySpec spec;
  spec.name = "box";
  spec.mass_kg = mass_kg;
  spec.inertia_B = box_inertia(mass_kg, half_extents_m);
  spec.X_WB.p = p_W;
  spec.shapes = {{BoxShape{half_extents_m}, {}}};
  return spec;
}

inline BodySpec make_sphere(double radius_m, double mass_kg, const Eigen::Vector3d& p_W) {
  BodySpec spec;
  spec.name = "sphere";
  spec.mass_kg = mass_kg;
  spec.inertia_B = Eigen::Matrix3d::Identity() * (0.4 * mass_kg * radius_m * radius_m);
  spec.X_WB.p = p_W;
  spec.shapes = {{SphereShape{radius_m}, {}}};
  return spec;
}

/// Unit vector, all directions alike.
inline Eigen::Vector3d random_direction(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return Eigen::Vector3d(x, y, z).normalized();
}

inline void run(PhysicsWorld& world, double duration_s) {
  const Duration dt = world.settings().step;
  const auto steps = std::llround(duration_s / dt.s());
  for (long long k = 0; k < steps; ++k) world.step(dt);
}

}  // namespace vinerow::physics::test
