#pragma once
/// Small worlds of boxes on level ground, and pictures straight down on them.

#include <memory>
#include <numbers>
#include <vector>

#include "engine/api/survey_camera.h"
#include "engine/api/world_model.h"
#include "engine/math/polygon.h"
#include "engine/physics/world_scene.h"
#include "worlds/mapping/photogrammetry/sampled_point.h"

namespace vinerow::test {

/// Closed box with its faces along the axes.
inline TriangleMesh box_mesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.push_back(Eigen::Vector3d((k & 1) != 0 ? high.x() : low.x(),
                                            (k & 2) != 0 ? high.y() : low.y(),
                                            (k & 4) != 0 ? high.z() : low.z())
                                .cast<float>());
  }
  const std::array<std::array<std::uint32_t, 4>, 6> faces = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& [a, b, c, d] : faces) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

inline MeshInstance box(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                        SurfaceClass surface = SurfaceClass::kCanopy) {
  MeshInstance instance;
  instance.name = "box";
  instance.mesh = std::make_shared<TriangleMesh>(box_mesh(low, high));
  instance.surface = surface;
  return instance;
}

/// Level ground at z = 0 within +-`half_m` and boxes on it.
inline WorldModel level_world(double half_m, std::vector<MeshInstance> boxes) {
  WorldModel world;
  world.name = "level";
  HeightField ground;
  ground.columns = ground.rows = 11;
  ground.cell_m = 0.2 * half_m;
  ground.corner_W = {-half_m, -half_m};
  ground.heights_m.assign(121, 0.0f);
  world.terrain = ground;
  world.meshes = std::move(boxes);
  return world;
}

inline Polygon square(double half_m) {
  return {{-half_m, -half_m}, {half_m, -half_m}, {half_m, half_m}, {-half_m, half_m}};
}

/// Straight down, the picture's upper edge to the east.
inline Pose looking_down(double x, double y, double height_m) {
  return {quaternion_from_rpy({0.0, 0.5 * std::numbers::pi, 0.0}), {x, y, height_m}};
}

/// 1 m of ground for each metre of height, in both directions; 1000 pixels.
inline SurveyCamera square_camera() {
  SurveyCamera camera;
  camera.focal_length_mm = 5.0;
  camera.sensor_width_mm = camera.sensor_height_mm = 5.0;
  camera.columns = camera.rows = 1000;
  return camera;
}

/// All points of a cloud.
struct Collected {
  std::vector<mapping::SampledPoint> points;
  mapping::CloudSink sink() {
    return [this](std::span<const mapping::SampledPoint> more) {
      points.insert(points.end(), more.begin(), more.end());
    };
  }
  bool operator==(const Collected& other) const {
    return std::equal(points.begin(), points.end(), other.points.begin(), other.points.end(),
                      [](const mapping::SampledPoint& a, const mapping::SampledPoint& b) {
                        return a.p_W == b.p_W && a.rgb == b.rgb && a.truth == b.truth;
                      });
  }
};

}  // namespace vinerow::test
