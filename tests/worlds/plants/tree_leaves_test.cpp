/// Leaves and fruit of trees: shapes, area, and what light meets.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "engine/api/map.h"
#include "engine/math/angles.h"
#include "engine/physics/static_scene.h"
#include "tests/worlds/world_fixture.h"
#include "worlds/plants/leaf_outline.h"
#include "worlds/plants/tree_leaves.h"

namespace vinerow::worlds::tree_leaves_test {
namespace {

double width_per_length(LeafKind kind) {
  double width = 0.0;
  for (const Eigen::Vector2d& p : leaf_outline(kind, 0)) width = std::max(width, 2.0 * p.y());
  return width;
}

double area_m2(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                          &c = mesh.vertices[t[2]];
    sum += 0.5 * (b - a).cross(c - a).norm();
  }
  return sum;
}

TEST(TreeLeaves, HaveTheProportionsOfTheirKind) {
  // Apple 7 to 10 by 4 to 6 cm, olive 5 to 7 by 1 to 1.5 cm.
  EXPECT_NEAR(width_per_length(LeafKind::kApple), 4.5 / 7.5, 0.05);
  EXPECT_NEAR(width_per_length(LeafKind::kOlive), 1.25 / 6.0, 0.04);
  const double apple_m = leaf_length_m(LeafKind::kApple, 30e-4);
  EXPECT_GT(apple_m, 0.07);
  EXPECT_LT(apple_m, 0.10);
  const double olive_m = leaf_length_m(LeafKind::kOlive, 5e-4);
  EXPECT_GT(olive_m, 0.05);
  EXPECT_LT(olive_m, 0.08);
}

TEST(TreeLeaves, FillTheCrownWithTheirArea) {
  const CrownSpace crown{{0.0, 0.0, 2.0}, {1.2, 0.9, 1.1}};
  const double volume_m3 = 4.0 / 3.0 * kPi * crown.half_axes_m.prod();
  for (const Crop crop : {Crop::kApple, Crop::kOlive}) {
    TreeLeaves leaves;
    leaves.crop = crop;
    for (int level = 0; level < 3; ++level) {
      const TriangleMesh mesh = make_tree_leaves(leaves, crown, level, RandomStream(1, "", "tree"));
      // Fold and bend add some hundredths to the area that is seen along the normal.
      EXPECT_NEAR(area_m2(mesh) / volume_m3, 2.6, 0.1 * 2.6) << level;
      for (const Eigen::Vector3f& v : mesh.vertices) {
        const Eigen::Vector3d from = v.cast<double>() - crown.centre;
        // A far leaf stands for thirty.
        EXPECT_LT(from.cwiseQuotient(crown.half_axes_m).norm(), level == 2 ? 1.6 : 1.2);
      }
    }
  }
}

TEST(TreeLeaves, LightMeetsThemInsteadOfTheHull) {
  ParameterSet parameters = test::world_parameters("orchard");
  ParameterSet leaves = parameters.make_group("leaves");
  leaves.set("leaf_area_per_m3", 1.0).set("fruits", 20.0);
  parameters.set("leaves", std::vector<ParameterSet>{leaves});
  const std::shared_ptr<const WorldModel> world = test::make_world("orchard", parameters);
  int fruit = 0;
  for (const MeshInstance& instance : world->meshes) {
    fruit += instance.name.starts_with("fruit/") ? 1 : 0;
    if (!instance.name.starts_with("crown_hull/")) continue;
    EXPECT_EQ(instance.light, Light::kPasses);
    EXPECT_TRUE(instance.collides);
  }
  EXPECT_GT(fruit, 0);
  const physics::StaticScene scene(world);
  const PlantRow& row = world->rows->rows.front();
  const Eigen::Vector3d along = (row.line_W.back() - row.line_W.front()).normalized();
  const Eigen::Vector3d across(-along.y(), along.x(), 0.0);
  int hull = 0, light = 0;
  for (double s_m = 2.0; s_m < 40.0; s_m += 0.11) {
    Eigen::Vector3d p_W = row.line_W.front() + s_m * along - 3.0 * across;
    p_W.z() += 0.5 * (row.canopy_base_m + row.canopy_top_m);
    const RayScene& seen = scene.light();
    hull += scene.queries().cast_ray(p_W, across, 6.0, mask_of(SurfaceClass::kCanopy)) ? 1 : 0;
    light += seen.cast_ray(p_W, across, 6.0, mask_of(SurfaceClass::kCanopy)) ? 1 : 0;
  }
  EXPECT_GT(light, hull / 4);
  EXPECT_LT(light, hull * 19 / 20) << "some pass between the leaves";
}

}  // namespace
}  // namespace vinerow::worlds::tree_leaves_test
