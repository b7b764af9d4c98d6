#pragma once
/// Small worlds and ways to look at pixels.

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>

#include "engine/api/height_field.h"
#include "engine/api/mesh.h"
#include "engine/render/cameras.h"
#include "engine/render/scene.h"

namespace vinerow::render::test {

/// Box with outward faces, without normals.
inline std::shared_ptr<TriangleMesh> make_box(const Eigen::Vector3f& half) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int i = 0; i < 8; ++i) {
    mesh->vertices.emplace_back((i & 1) ? half.x() : -half.x(), (i & 2) ? half.y() : -half.y(),
                                (i & 4) ? half.z() : -half.z());
  }
  const std::array<std::array<std::uint32_t, 4>, 6> faces = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& f : faces) {
    mesh->triangles.push_back({f[0], f[1], f[2]});
    mesh->triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

inline MeshInstance make_instance(const std::string& name, std::shared_ptr<const TriangleMesh> mesh,
                                  const Eigen::Vector3d& p_W, const Eigen::Vector3f& colour) {
  MeshInstance instance;
  instance.name = name;
  instance.mesh = std::move(mesh);
  instance.X_WM.p = p_W;
  instance.material.colour = colour;
  return instance;
}

/// Level ground at z = 0 from -size to +size.
inline HeightField make_level_ground(double size_m) {
  HeightField field;
  field.columns = field.rows = 33;
  field.cell_m = 2.0 * size_m / 32.0;
  field.corner_W = {-size_m, -size_m};
  field.heights_m.assign(33 * 33, 0.0f);
  return field;
}

/// Draws, or skips the test where the machine has no OSMesa.
inline std::unique_ptr<Renderer> renderer_of(const WorldModel& world,
                                             const RendererSettings& settings = {}) {
  Result<std::unique_ptr<Renderer>> made = make_renderer(world, settings);
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.reason());
  return made.ok() ? std::move(made).value() : nullptr;
}

inline Eigen::Vector3i pixel(const Image& image, int x, int y) {
  const std::uint8_t* p = &image.rgb[(static_cast<std::size_t>(y) * image.width + x) * 3];
  return {p[0], p[1], p[2]};
}

inline double brightness(const Image& image, const Eigen::Vector2d& place) {
  double sum = 0.0;
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      sum += pixel(image, static_cast<int>(place.x()) + dx, static_cast<int>(place.y()) + dy).sum();
    }
  }
  return sum / (25.0 * 3.0);
}

/// Red clearly above the other channels: nothing in sky or ground is.
inline bool is_red(const Eigen::Vector3i& p) {
  return p[0] > 60 && p[0] > 2 * p[1] && p[0] > 2 * p[2];
}

/// Smallest box around the pixels that satisfy `condition`; empty if none does.
template <class F>
Eigen::AlignedBox2i box_of(const Image& image, F&& condition) {
  Eigen::AlignedBox2i box;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (condition(pixel(image, x, y))) box.extend(Eigen::Vector2i(x, y));
    }
  }
  return box;
}

}  // namespace vinerow::render::test
