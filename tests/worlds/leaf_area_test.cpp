/// Leaf area of plants: in hulls, on the ground, and the shelter that follows.

#include "worlds/parts/leaf_area.h"

#include <gtest/gtest.h>

#include "engine/api/foliage.h"
#include "engine/api/map.h"
#include "engine/math/angles.h"
#include "tests/support/folder_test.h"
#include "tests/worlds/world_fixture.h"
#include "worlds/plants/vine_organs.h"

namespace vinerow::worlds::leaf_area_test {
namespace {

using Groups = std::vector<ParameterSet>;

ParameterSet vineyard_at(double bbch) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_count", 3.0).set("row_length_m", 22.0).set("relief_m", 0.0);
  parameters.set("waves_m", 0.0).set("missing_vine_share", 0.0);
  ParameterSet vines = parameters.make_group("vines");
  vines.set("bbch", bbch);
  parameters.set("vines", Groups{vines});
  return parameters;
}

ParameterSet sheltered(ParameterSet parameters) {
  ParameterSet wind = parameters.make_group("wind");
  wind.set("mean_speed_mps", 3.0).set("shelter_by_leaves", true);
  parameters.set("wind", Groups{wind});
  return parameters;
}

TEST(LeafArea, OfABox) {
  // Two by three by four, about any point.
  TriangleMesh box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.emplace_back(5.0f + 2.0f * static_cast<float>(i & 1),
                              7.0f + 3.0f * static_cast<float>((i >> 1) & 1),
                              -9.0f + 4.0f * static_cast<float>(i >> 2));
  }
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  EXPECT_NEAR(enclosed_volume_m3(box), 24.0, 1e-4);
  EXPECT_NEAR(foliage_in(box, 48.0, 0.1).area_density_m2pm3, 2.0, 1e-5);
}

TEST(LeafArea, OfAVineyardIsThatOfItsLeaves) {
  const auto world = test::make_world("vineyard", vineyard_at(75.0));
  double hulls_m2 = 0.0, leaves_m2 = 0.0;
  for (const MeshInstance& instance : world->meshes) {
    if (instance.foliage) {
      EXPECT_TRUE(instance.name.starts_with("canopy_hull/")) << instance.name;
      hulls_m2 += instance.foliage->area_density_m2pm3 * enclosed_volume_m3(*instance.mesh);
    }
    if (!instance.name.starts_with("canopy/") || !instance.name.ends_with("#lod0")) continue;
    const TriangleMesh& mesh = *instance.mesh;
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                            &c = mesh.vertices[t[2]];
      leaves_m2 += 0.5 * static_cast<double>((b - a).cross(c - a).norm());
    }
  }
  // Stalks and bent rims add to the area of the blades' outlines.
  EXPECT_GT(hulls_m2, 100.0);
  EXPECT_NEAR(leaves_m2 / hulls_m2, 1.0, 0.12);
  // 3.4 m2 of leaves on a metre of row (vine_growth_test), rows 2.5 m apart unless given.
  const double pitch_m = world->rows->alleys.front().width_m;
  EXPECT_NEAR(leaf_area_index(*world), 3.4 / pitch_m, 0.15 * 3.4 / pitch_m);
}

TEST(LeafArea, GivesRaysTheirDensity) {
  const auto world = test::make_world("vineyard", vineyard_at(75.0));
  const LeafAreaDensity density(*world);
  for (std::size_t i = 0; i < world->meshes.size(); ++i) {
    const MeshInstance& instance = world->meshes[i];
    const double of_mesh = density.of(static_cast<int>(i));
    if (instance.name.starts_with("canopy_hull/")) {
      EXPECT_GT(of_mesh, 3.0);
      EXPECT_LT(of_mesh, 12.0);
    } else {
      EXPECT_EQ(of_mesh, kUsualLeafAreaDensity_m2pm3);
    }
  }
  EXPECT_EQ(density.of(-1), kUsualLeafAreaDensity_m2pm3);
}

TEST(ShelterByLeaves, IsGoudriaansAttenuation) {
  // The figure of the parameter's description: LAI 2, 2 m, leaves of 0.1 m.
  EXPECT_NEAR(shelter_attenuation(2.0, 2.0, 0.1), 1.2, 0.01);
  const auto world = test::make_world("vineyard", sheltered(vineyard_at(75.0)));
  const double expected = shelter_attenuation(
      leaf_area_index(*world), world->rows->rows.front().canopy_top_m, std::sqrt(0.0107));
  EXPECT_NEAR(world->wind.shelter_attenuation, expected, 0.05 * expected);
  EXPECT_GT(world->wind.shelter_attenuation, 0.6);
}

TEST(ShelterByLeaves, GrowsWithTheSeason) {
  double before = -1.0;
  for (const double bbch : {0.0, 15.0, 57.0, 75.0}) {
    const double attenuation =
        test::make_world("vineyard", sheltered(vineyard_at(bbch)))->wind.shelter_attenuation;
    EXPECT_GT(attenuation, before) << bbch;
    if (bbch == 0.0) {
      EXPECT_EQ(attenuation, 0.0);
    }
    before = attenuation;
  }
}

/// Every vehicle checks the wind that it meets.
TEST(ShelterByLeaves, IsAWindThatVehiclesAccept) {
  for (const double bbch : {0.0, 15.0, 75.0, 97.0}) {
    const auto world = test::make_world("vineyard", sheltered(vineyard_at(bbch)));
    EXPECT_NO_THROW(validate(world->wind)) << bbch;
  }
}

TEST(ShelterByLeaves, OfDenseTreesStaysInTheRangeOfTheParameter) {
  ParameterSet parameters = test::world_parameters("orchard");
  parameters.set("field_width_m", 10.0).set("plant_rows", 2.0).set("row_width_m", 3.0);
  parameters.set("field_length_m", 20.0).set("row_length_m", 7.0);
  ParameterSet leaves = parameters.make_group("leaves");
  leaves.set("crop", std::string("olive")).set("leaf_area_per_m3", 20.0);
  parameters.set("leaves", Groups{leaves});
  const auto world = test::make_world("orchard", sheltered(parameters));
  // Goudriaan for these: 0.28 (LAI^2 h / w)^(1/3) with LAI > 10, h = 3.6 m, w = 0.022 m is over 7.
  EXPECT_GT(leaf_area_index(*world), 10.0);
  EXPECT_EQ(world->wind.shelter_attenuation, 5.0);
  EXPECT_NO_THROW(validate(world->wind));
}

TEST(ShelterByLeaves, NeedsPlantsWhoseLeavesAreKnown) {
  ParameterSet cards = test::world_parameters("vineyard");
  EXPECT_EQ(test::config_error_of([&] { test::make_world("vineyard", sheltered(cards)); }),
            "wind: shelter_by_leaves = true, but the world does not know the leaf area of its "
            "plants: give them leaves one by one (vines, leaves) or give wind.shelter");
  ParameterSet both = cards.make_group("wind");
  EXPECT_EQ(test::config_error_of([&] {
              both.set("shelter_by_leaves", true).set("shelter", 1.0);
              cards.set("wind", Groups{both});
              test::make_world("vineyard", cards);
            }),
            "wind: shelter and shelter_by_leaves exclude each other: give one of them");
}

}  // namespace
}  // namespace vinerow::worlds::leaf_area_test
