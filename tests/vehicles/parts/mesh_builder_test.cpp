#include "vehicles/parts/mesh_builder.h"

#include <gtest/gtest.h>

#include "engine/math/angles.h"
#include "vehicles/diff_drive_rover/rover_mesh.h"
#include "vehicles/parts/wheel_mesh.h"

namespace vinerow::vehicles::mesh_builder_test {
namespace {

/// Signed volume by the divergence theorem; positive when faces look outwards.
double volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>(),
                          b = mesh.vertices[t[1]].cast<double>(),
                          c = mesh.vertices[t[2]].cast<double>();
    sum += a.dot(b.cross(c)) / 6.0;
  }
  return sum;
}

/// Every face looks where its vertex normals look, and all arrays have their size.
void expect_consistent(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  ASSERT_EQ(mesh.colours.size(), mesh.vertices.size());
  std::size_t wrong = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f face = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                                     .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    for (const auto index : t) {
      ASSERT_TRUE(mesh.vertices[index].allFinite());
      ASSERT_NEAR(mesh.normals[index].norm(), 1.0f, 1e-4f);
      if (face.norm() > 1e-9f && face.dot(mesh.normals[index]) <= 0.0f) ++wrong;
    }
  }
  EXPECT_EQ(wrong, 0u) << "of " << 3 * mesh.triangles.size();
}

TEST(MeshBuilder, BoxHasItsVolume) {
  const TriangleMesh sharp = MeshBuilder().box({0.5, 0.3, 0.2}, 0.0).take();
  expect_consistent(sharp);
  EXPECT_NEAR(volume(sharp), 8 * 0.5 * 0.3 * 0.2, 1e-6);
  const TriangleMesh cut = MeshBuilder().box({0.5, 0.3, 0.2}, 0.02).take();
  expect_consistent(cut);
  // Twelve edges lose a right triangle of c^2/2 over their length; the corners change it by c^3.
  const double lost = 0.5 * 0.02 * 0.02 * 4 * 2 * (0.5 + 0.3 + 0.2);
  EXPECT_NEAR(volume(cut), 0.24 - lost, 8 * 0.02 * 0.02 * 0.02);
}

TEST(MeshBuilder, CylinderAndRodHaveTheirVolume) {
  // A regular polygon of n sides has the area n/2 r^2 sin(2 pi / n).
  const double area = 0.5 * 24 * 0.01 * std::sin(2 * kPi / 24);
  const TriangleMesh cylinder = MeshBuilder().cylinder(0.1, 0.25, 24).take();
  expect_consistent(cylinder);
  EXPECT_NEAR(volume(cylinder), area * 0.5, 1e-6);
  const TriangleMesh rod = MeshBuilder().rod({1, 2, 3}, {1.3, 2, 3.4}, 0.1, 24).take();
  expect_consistent(rod);
  EXPECT_NEAR(volume(rod), area * 0.5, 1e-5);
}

TEST(MeshBuilder, ExtrusionAndRingSectorFaceOutwards) {
  const Eigen::Vector2d outline[] = {{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}};
  const TriangleMesh plain = MeshBuilder().extrude(outline, 0.2, 0.0).take();
  expect_consistent(plain);
  EXPECT_NEAR(volume(plain), 0.2, 1e-6);
  const TriangleMesh bevelled = MeshBuilder().extrude(outline, 0.2, 0.02).take();
  expect_consistent(bevelled);
  EXPECT_LT(volume(bevelled), 0.2);
  EXPECT_GT(volume(bevelled), 0.195);
  const TriangleMesh ring = MeshBuilder().ring_sector(0.2, 0.25, 0.1, 0.3, 2.0, 40).take();
  expect_consistent(ring);
  EXPECT_NEAR(volume(ring), 0.5 * (0.0625 - 0.04) * 1.7 * 0.2, 1e-5);
}

TEST(WheelMesh, IsAsLargeAsTheWheel) {
  for (const bool left : {true, false}) {
    WheelMeshParams params;
    params.left = left;
    const TriangleMesh mesh = make_wheel_mesh(params);
    expect_consistent(mesh);
    const Eigen::AlignedBox3d box = mesh.bounds();
    EXPECT_NEAR(box.max().z(), 0.2, 0.006);
    EXPECT_NEAR(box.min().x(), -0.2, 0.006);
    EXPECT_NEAR(box.sizes().y(), 0.16, 0.015);
    EXPECT_LT(mesh.triangles.size(), 4000u);  // four of them in every frame
  }
}

TEST(RoverMesh, StandsAboveTheGroundAndIsOfTheVehiclesSize) {
  const ChassisParams params;
  const TriangleMesh mesh = make_rover_mesh(params);
  expect_consistent(mesh);
  const Eigen::AlignedBox3d box = mesh.bounds();
  EXPECT_GT(box.min().z() + params.com_height_m, 0.12);
  EXPECT_LT(box.max().z() + params.com_height_m, 1.6);
  EXPECT_NEAR(box.sizes().x(), 2.0, 0.15);
  EXPECT_LT(box.sizes().y(), 1.25);
  EXPECT_LT(mesh.triangles.size(), 8000u);
}

}  // namespace
}  // namespace vinerow::vehicles::mesh_builder_test
