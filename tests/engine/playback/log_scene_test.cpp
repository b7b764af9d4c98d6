#include "engine/playback/log_scene.h"

#include <gtest/gtest.h>

#include <map>

#include "engine/api/map.h"
#include "engine/api/vehicle.h"
#include "engine/api/world_model.h"

namespace vinerow::playback::log_scene_test {
namespace {

using Eigen::Vector3d;
using record::SceneEntity;
using record::SceneTriangles;

const SceneTriangles& part(const std::vector<SceneEntity>& scene, const std::string& id) {
  static const SceneTriangles none;
  for (const SceneEntity& entity : scene) {
    if (entity.id == id) return entity.triangles.front();
  }
  ADD_FAILURE() << "no " << id;
  return none;
}

bool has(const std::vector<SceneEntity>& scene, const std::string& id) {
  for (const SceneEntity& entity : scene) {
    if (entity.id == id) return true;
  }
  return false;
}

/// By the divergence theorem: positive where the triangles face outward.
double volume_m3(const SceneTriangles& t) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < t.indices.size(); i += 3) {
    const Vector3d &a = t.points[t.indices[i]], &b = t.points[t.indices[i + 1]],
                   &c = t.points[t.indices[i + 2]];
    sum += a.dot(b.cross(c)) / 6.0;
  }
  return sum;
}

/// Each edge is run through once in each direction.
bool is_closed(const SceneTriangles& t) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i + 2 < t.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++edges[{t.indices[i + k], t.indices[i + (k + 1) % 3]}];
    }
  }
  for (const auto& [edge, count] : edges) {
    const auto opposite = edges.find({edge.second, edge.first});
    if (count != 1 || opposite == edges.end() || opposite->second != 1) return false;
  }
  return !edges.empty();
}

/// A slope of 10 % along x, 400 m x 200 m, with a row of 40 m.
WorldModel slope() {
  WorldModel world;
  HeightField ground;
  ground.columns = 401;
  ground.rows = 201;
  ground.cell_m = 1.0;
  ground.corner_W = {-200, -100};
  for (int j = 0; j < ground.rows; ++j) {
    for (int i = 0; i < ground.columns; ++i) {
      ground.heights_m.push_back(0.1f * static_cast<float>(i - 200));
    }
  }
  world.terrain = ground;
  PlantRow row;
  row.line_W = {{-20, 3, -2}, {20, 3, 2}};
  row.canopy_width_m = 0.5;
  row.canopy_base_m = 0.6;
  row.canopy_top_m = 1.8;
  world.rows->rows.push_back(row);
  return world;
}

MeshInstance triangle(const std::string& name, SurfaceClass surface) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh->triangles = {{0, 1, 2}};
  MeshInstance instance;
  instance.name = name;
  instance.mesh = mesh;
  instance.surface = surface;
  instance.X_WM.p = {5, 6, 7};
  return instance;
}

TEST(LogScene, TheGroundIsTheTerrainsAndFinerAroundTheRows) {
  const auto scene = world_scene(slope());
  const SceneTriangles& ground = part(scene, "ground");
  EXPECT_LT(ground.points.size(), 14'000u);
  double area_m2 = 0.0, min_m2 = 1e9;
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : ground.points) {
    box.extend(p);
    // The coarse one lies lower, so that it hides nothing of the fine one.
    EXPECT_NEAR(p.z(), 0.1 * p.x() - 0.075, 0.0751);
  }
  for (std::size_t i = 0; i < ground.indices.size(); i += 3) {
    const Vector3d a = ground.points[ground.indices[i]];
    const Vector3d n =
        (ground.points[ground.indices[i + 1]] - a).cross(ground.points[ground.indices[i + 2]] - a);
    EXPECT_GT(n.z(), 0.0) << "seen from above";
    area_m2 += 0.5 * n.z();
    min_m2 = std::min(min_m2, 0.5 * n.z());
  }
  EXPECT_EQ(box.min().x(), -200);
  EXPECT_EQ(box.max().y(), 100);
  EXPECT_GE(area_m2, 400.0 * 200.0) << "no hole";
  EXPECT_LE(area_m2, 400.0 * 200.0 + 70.0 * 31.0 + 2 * 400.0) << "no more than a seam twice";
  EXPECT_LE(min_m2, 0.51) << "half a cell of 1 m near the row";
}

TEST(LogScene, ARowIsABarOfItsCanopy) {
  const auto scene = world_scene(slope());
  const SceneTriangles& canopy = part(scene, "canopy");
  EXPECT_TRUE(is_closed(canopy));
  EXPECT_NEAR(volume_m3(canopy), 40.0 * 0.5 * 1.2, 1e-6);
  for (const Vector3d& p : canopy.points) {
    const double above_m = p.z() - 0.1 * p.x();
    EXPECT_LT(std::min(std::abs(above_m - 0.6), std::abs(above_m - 1.8)), 1e-5);
  }
}

TEST(LogScene, ThingsStandWhereTheirMeshesDoEachOnce) {
  WorldModel world = slope();
  world.meshes.push_back(triangle("post/a", SurfaceClass::kPost));
  world.meshes.push_back(triangle("trunk/a#lod0", SurfaceClass::kTrunk));
  world.meshes.push_back(triangle("trunk/a#lod1", SurfaceClass::kTrunk));
  MeshInstance hull = triangle("canopy_hull/a", SurfaceClass::kCanopy);
  hull.visible = false;
  world.meshes.push_back(hull);
  MeshInstance leaves = triangle("canopy/a#lod0", SurfaceClass::kCanopy);
  leaves.collides = false;
  world.meshes.push_back(leaves);
  auto scene = world_scene(world);
  for (const char* id : {"post", "trunk", "canopy"}) {
    EXPECT_EQ(part(scene, id).points, (std::vector<Vector3d>{{5, 6, 7}, {6, 6, 7}, {5, 7, 7}}))
        << id;
  }
  EXPECT_FALSE(has(scene, "wire"));
  // Where it becomes too much, the trunks go first and rows become bars.
  SceneLimits limits;
  limits.solid_points = 4;
  limits.canopy_points = 2;
  scene = world_scene(world, limits);
  EXPECT_TRUE(has(scene, "post"));
  EXPECT_FALSE(has(scene, "trunk"));
  EXPECT_NEAR(volume_m3(part(scene, "canopy")), 24.0, 1e-6);
}

TEST(LogScene, AVehiclesLinksMoveWithTheirFrames) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
  mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const std::vector<VehicleLink> links = {{"hull", mesh, {}}, {"none", nullptr, {}}};
  auto scene = vehicle_scene("rover", links);
  ASSERT_EQ(scene.size(), 1u);
  EXPECT_EQ(scene[0].frame, "rover/hull");
  EXPECT_NEAR(volume_m3(scene[0].triangles[0]), 4.0, 1e-12);
  SceneLimits limits;
  limits.vehicle_points = 3;
  scene = vehicle_scene("rover", links, limits);
  EXPECT_TRUE(is_closed(scene[0].triangles[0])) << "a box in place of too many triangles";
  EXPECT_NEAR(volume_m3(scene[0].triangles[0]), 24.0, 1e-12);
  // A frame has one parent: a sensor that is called like a link has a frame of another name.
  EXPECT_EQ(sensor_frame("rover", "lidar", links), "rover/lidar");
  EXPECT_EQ(sensor_frame("rover", "hull", links), "rover/hull_sensor");
}

}  // namespace
}  // namespace vinerow::playback::log_scene_test
