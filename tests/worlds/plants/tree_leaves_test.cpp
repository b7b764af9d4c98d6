/// Leaves and fruit of trees: shapes, area, and what light meets.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/api/map.h"
#include "engine/math/angles.h"
#include "engine/physics/static_scene.h"
#include "tests/support/folder_test.h"
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

TEST(TreeLeaves, HaveTheAreaOfTheirStage) {
  const CrownSpace crown{{0.0, 0.0, 2.0}, {1.2, 0.9, 1.1}};
  const double volume_m3 = 4.0 / 3.0 * kPi * crown.half_axes_m.prod();
  TreeLeaves apple;
  const auto share_at = [&](double bbch) {
    apple.bbch = bbch;
    const double share = leaf_area_m2(apple, crown) / volume_m3 / 2.6;
    for (int level = 0; level < 2; ++level) {
      const TriangleMesh mesh = make_tree_leaves(apple, crown, level, RandomStream(1, "", "tree"));
      EXPECT_NEAR(area_m2(mesh) / volume_m3 / 2.6, share, 0.02 + 0.12 * share) << bbch << level;
    }
    return share;
  };
  // Forshey et al. 1987: 10 % at full bloom, 23 % at petal fall, eightfold four weeks after bloom,
  // when apples have about 20 mm.
  EXPECT_NEAR(share_at(65.0), 0.10, 0.01);
  EXPECT_NEAR(share_at(69.0), 0.23, 0.01);
  EXPECT_NEAR(share_at(72.0), 0.80, 0.01);
  EXPECT_EQ(share_at(79.0), 1.0);
  EXPECT_EQ(share_at(0.0), 0.0);
  EXPECT_EQ(share_at(97.0), 0.0);
  EXPECT_LT(share_at(95.0), 0.8);
  TreeLeaves olive;
  olive.crop = Crop::kOlive;
  olive.bbch = 0.0;
  EXPECT_GT(leaf_area_m2(olive, crown), 0.7 * 2.6 * volume_m3) << "olives are evergreen";
}

TEST(TreeLeaves, OfALaterStageAreTheSameLeaves) {
  // Every leaf of petal fall lies where one of the full crown lies.
  const CrownSpace crown{{0.0, 0.0, 2.0}, {1.2, 0.9, 1.1}};
  TreeLeaves apple;
  const TriangleMesh full = make_tree_leaves(apple, crown, 0, RandomStream(1, "", "tree"));
  apple.bbch = 69.0;
  const TriangleMesh young = make_tree_leaves(apple, crown, 0, RandomStream(1, "", "tree"));
  const auto firsts = [](const TriangleMesh& mesh) {
    std::vector<std::array<float, 3>> points;
    for (const std::uint32_t t : mesh.things) {
      const Eigen::Vector3f& v = mesh.vertices[mesh.triangles[t][0]];
      points.push_back({v.x(), v.y(), v.z()});
    }
    std::sort(points.begin(), points.end());
    return points;
  };
  const auto a = firsts(young), b = firsts(full);
  EXPECT_LT(a.size(), b.size());
  std::size_t found = 0;
  for (const auto& p : a) {
    const auto near = [&](const auto& q) {
      return std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]) < 0.005f;
    };
    found += std::any_of(b.begin(), b.end(), near) ? 1u : 0u;
  }
  EXPECT_EQ(found, a.size());
}

TEST(TreeFruit, GrowsFromFlowers) {
  const CrownSpace crown{{0.0, 0.0, 2.0}, {1.2, 0.9, 1.1}};
  TreeLeaves apple;
  const auto at = [&](double bbch) {
    apple.bbch = bbch;
    return make_fruit(apple, crown, RandomStream(1, "", "fruit"));
  };
  const auto first_width_m = [](const TriangleMesh& mesh) {
    Eigen::AlignedBox3f box;
    const std::uint32_t end =
        mesh.things.size() > 1 ? mesh.things[1] : static_cast<std::uint32_t>(mesh.triangles.size());
    for (std::uint32_t t = 0; t < end; ++t) {
      for (const std::uint32_t v : mesh.triangles[t]) box.extend(mesh.vertices[v]);
    }
    return box.sizes().maxCoeff();
  };
  for (const double bbch : {0.0, 19.0, 55.0, 92.0}) EXPECT_TRUE(at(bbch).triangles.empty()) << bbch;
  // Clusters of five flowers, each as wide as a hand.
  const TriangleMesh bloom = at(65.0);
  EXPECT_EQ(bloom.things.size(), 3u * 60u);
  EXPECT_NEAR(first_width_m(bloom), 0.09, 0.04);
  EXPECT_GT(bloom.colours.front().minCoeff(), 0.45f);
  EXPECT_LT(at(67.5).triangles.size(), bloom.triangles.size() / 2);
  // 10 and 20 mm by definition of 71 and 72; half of the final size at 75.
  EXPECT_EQ(at(71.0).things.size(), 60u);
  const double ripe_m = first_width_m(at(89.0));
  // 70 mm, from 0.85 to 1.1 of it; a sphere of 20 faces is a little smaller.
  EXPECT_GT(ripe_m, 0.85 * 0.85 * 0.07);
  EXPECT_LT(ripe_m, 1.1 * 0.07);
  EXPECT_NEAR(first_width_m(at(71.0)) / ripe_m, 10.0 / 70.0, 0.01);
  EXPECT_NEAR(first_width_m(at(72.0)) / ripe_m, 20.0 / 70.0, 0.01);
  EXPECT_NEAR(first_width_m(at(75.0)) / ripe_m, 0.5, 0.06);
  // Green turns red.
  const auto redness = [&](double bbch) {
    const Eigen::Vector3f c = at(bbch).colours.front();
    return c.x() / c.y();
  };
  EXPECT_LT(redness(79.0), 1.0f);
  EXPECT_GT(redness(89.0), 5.0f);
}

TEST(TreeLeaves, ABareTreeHasTwigsAndNoHull) {
  ParameterSet parameters = test::world_parameters("orchard");
  parameters.set("plant_rows", 1.0).set("row_length_m", 12.0);
  ParameterSet leaves = parameters.make_group("leaves");
  leaves.set("bbch", 0.0);
  parameters.set("leaves", std::vector<ParameterSet>{leaves});
  const std::shared_ptr<const WorldModel> world = test::make_world("orchard", parameters);
  int twigs = 0;
  for (const MeshInstance& instance : world->meshes) {
    EXPECT_NE(instance.surface, SurfaceClass::kCanopy) << instance.name;
    twigs += instance.name.starts_with("twigs/") ? 1 : 0;
  }
  EXPECT_GT(twigs, 0);
}

TEST(TreeLeaves, JustPlantedTreesHaveNoMeshWithoutTriangles) {
  for (const double width_m : {0.5, 0.1}) {
    ParameterSet parameters = test::world_parameters("orchard");
    parameters.set("plant_rows", 1.0).set("row_length_m", 12.0).set("row_width_m", width_m);
    parameters.set("tree_spacing_m", 1.0).set("tree_height_m", 1.4);
    ParameterSet leaves = parameters.make_group("leaves");
    leaves.set("bbch", 10.0);
    parameters.set("leaves", std::vector<ParameterSet>{leaves});
    const std::shared_ptr<const WorldModel> world = test::make_world("orchard", parameters);
    for (const MeshInstance& instance : world->meshes) {
      EXPECT_FALSE(instance.mesh->triangles.empty()) << instance.name;
    }
  }
}

TEST(TreeLeaves, TwigsOfAYoungTreeStayNearItsCrown) {
  // A crown of half a metre each way; shoots of the year are as long as that at most.
  const CrownSpace crown{{0.0, 0.0, 1.2}, {0.25, 0.25, 0.25}};
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const TriangleMesh twigs = make_twigs(crown, RandomStream(seed, "", "twigs"));
    for (const Eigen::Vector3f& v : twigs.vertices) {
      EXPECT_LT((v.cast<double>() - crown.centre).norm(), 0.25 * 1.4);
    }
  }
}

TEST(TreeLeaves, AStageThatRunsBesideOthersIsRefused) {
  for (const double bbch : {20.0, 35.0, 50.0}) {
    ParameterSet parameters = test::world_parameters("orchard");
    EXPECT_EQ(test::config_error_of([&] {
                ParameterSet leaves = parameters.make_group("leaves");
                leaves.set("bbch", bbch);
                parameters.set("leaves", std::vector<ParameterSet>{leaves});
                test::make_world("orchard", parameters);
              }),
              fmt::format("leaves: bbch = {}, stages 20 to 50 run beside leaves and flowers: give "
                          "0 to 19 or 51 to 99",
                          bbch));
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
