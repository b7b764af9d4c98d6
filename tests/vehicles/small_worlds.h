#pragma once
/// Grounds of a few lines for the tests of vehicles.

#include <cmath>
#include <functional>
#include <memory>

#include "engine/api/world_model.h"
#include "engine/physics/physics_world.h"

namespace vinerow::vehicles::test {

constexpr double kGravity = 9.80665;

/// Height field around the origin, `size_m` wide and deep.
inline WorldModel make_world(double size_m, double cell_m,
                             const std::function<double(double, double)>& height) {
  WorldModel world;
  HeightField field;
  field.cell_m = cell_m;
  field.columns = field.rows = static_cast<int>(std::lround(size_m / cell_m)) + 1;
  field.corner_W = {-0.5 * size_m, -0.5 * size_m};
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      field.heights_m.push_back(static_cast<float>(
          height(field.corner_W.x() + i * cell_m, field.corner_W.y() + j * cell_m)));
    }
  }
  world.terrain = std::move(field);
  return world;
}

inline WorldModel make_flat_world() {
  return make_world(200.0, 1.0, [](double, double) { return 0.0; });
}

/// Rises along +x.
inline WorldModel make_slope_world(double angle_rad) {
  const double slope = std::tan(angle_rad);
  return make_world(200.0, 1.0, [slope](double x, double) { return slope * x; });
}

/// Pose of B on the ground at (x, y), standing normal to it.
inline Pose pose_on_ground(const WorldModel& world, double x, double y, double yaw_rad,
                           double height_m) {
  const Eigen::Vector3d normal = world.terrain->normal_W(x, y);
  Pose pose;
  pose.q = quaternion_on_slope(yaw_rad, normal);
  pose.p = Eigen::Vector3d(x, y, world.terrain->height_m(x, y)) + height_m * normal;
  return pose;
}

/// Mesh box with the half extents given, standing at p_W.
inline MeshInstance make_box(const std::string& name, const Eigen::Vector3f& half,
                             const Eigen::Vector3d& p_W, SurfaceClass surface) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int k = 0; k < 8; ++k) {
    mesh->vertices.emplace_back(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(),
                                k & 4 ? half.z() : -half.z());
  }
  mesh->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  MeshInstance instance;
  instance.name = name;
  instance.mesh = mesh;
  instance.X_WM.p = p_W;
  instance.surface = surface;
  return instance;
}

inline physics::PhysicsSettings settings_with_step(std::int64_t step_ns) {
  physics::PhysicsSettings settings;
  settings.step.ns = step_ns;
  return settings;
}

}  // namespace vinerow::vehicles::test
