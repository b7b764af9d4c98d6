#include "engine/api/map.h"
#include "worlds/mapping/photogrammetry/cloud_truth.h"

#include <gtest/gtest.h>

#include <fstream>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/support/paths.h"
#include "tests/worlds/mapping/photogrammetry/cloud_scene.h"
#include "tests/worlds/world_fixture.h"

namespace vinerow::mapping::cloud_truth_test {
namespace {

using Eigen::Vector3d;

/// Two rows from west to east, 2.5 m apart, canopies of boxes; the northern one has a gap.
WorldModel two_rows() {
  WorldModel world = test::level_world(
      50.0, {test::box({-9, -0.3, 0.5}, {9, 0.3, 2.0}), test::box({-9, 2.3, 0.4}, {-1, 2.9, 1.9}),
             test::box({1, 2.2, 0.6}, {7, 2.8, 2.1}), test::box({7.3, 2.2, 0.6}, {9.3, 2.8, 2.1})});
  for (const double y : {0.0, 2.5}) {
    PlantRow row;
    row.id = y > 0.0 ? 1 : 0;
    row.line_W = {{-10, y, 0}, {10, y, 0}};
    world.rows->rows.push_back(row);
  }
  world.rows->boundary_W = test::square(20.0);
  return world;
}

TEST(CloudTruth, MeasuresRowsOfBoxes) {
  const WorldModel world = two_rows();
  const physics::WorldScene scene(world);
  const CloudTruth truth = measure_truth(scene, world);
  ASSERT_EQ(truth.rows.size(), 2u);
  const RowTruth &south = truth.rows[0], &north = truth.rows[1];
  EXPECT_TRUE(south.first_W.isApprox(Vector3d(-9, 0, 0), 1e-4)) << south.first_W.transpose();
  EXPECT_TRUE(south.last_W.isApprox(Vector3d(9, 0, 0), 1e-4)) << south.last_W.transpose();
  EXPECT_NEAR(south.length_m, 18.0, 1e-3);
  EXPECT_NEAR(south.bearing_deg, 90.0, 1e-6);
  EXPECT_NEAR(south.spacing_m, 2.5, 1e-9);
  EXPECT_EQ(north.spacing_m, 0.0);
  EXPECT_NEAR(south.canopy_base_m, 0.5, 1e-6);
  EXPECT_NEAR(south.canopy_top_m, 2.0, 1e-6);
  EXPECT_NEAR(south.canopy_width_m, 0.6, 1e-6);
  EXPECT_NEAR(south.volume_m3, 18.0 * 0.6 * 1.5, 0.01);
  EXPECT_TRUE(south.gaps_m.empty());

  EXPECT_NEAR(north.last_W.x(), 9.3, 1e-3);
  ASSERT_EQ(north.gaps_m.size(), 1u) << "0.3 m are no gap";
  EXPECT_NEAR(north.gaps_m[0].first, 8.0, 1e-3);
  EXPECT_NEAR(north.gaps_m[0].second, 10.0, 1e-3);
  EXPECT_NEAR(north.volume_m3, 16.0 * 0.6 * 1.5, 0.01);
  EXPECT_NEAR(north.canopy_base_m, 0.5, 1e-6) << "8 m of 0.4 and 8 m of 0.6";
  EXPECT_NEAR(north.canopy_top_m, 2.0, 1e-6);
  EXPECT_NEAR(truth.volume_m3, south.volume_m3 + north.volume_m3, 1e-9);
  EXPECT_NEAR(truth.bearing_deg, 90.0, 1e-6);
  EXPECT_NEAR(truth.spacing_m, 2.5, 1e-9);
  EXPECT_EQ(truth.boundary_W.size(), 4u);
}

TEST(CloudTruth, ARowWithoutCanopyHasNone) {
  WorldModel world = two_rows();
  world.meshes.resize(1);
  const physics::WorldScene scene(world);
  const RowTruth bare = measure_truth(scene, world).rows[1];
  EXPECT_EQ(bare.length_m, 0.0);
  EXPECT_EQ(bare.volume_m3, 0.0);
  EXPECT_EQ(bare.canopy_top_m, 0.0);
}

// Second way to the volume of a hull that does not cross itself: the divergence theorem.
TEST(CloudTruth, OfAVineyardAgreesWithItsParameters) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_count", std::int64_t{3})
      .set("row_length_m", 27.0)
      .set("missing_vine_share", 0.0);
  parameters.set("row_bend_deg", 20.0).set("leaf_cards_per_m", 10.0);
  const auto world = test::make_world("vineyard", parameters);
  const physics::WorldScene scene(*world);
  const CloudTruth truth = measure_truth(scene, *world);
  ASSERT_EQ(truth.rows.size(), 3u);
  double volume_m3 = 0.0;
  for (const MeshInstance& instance : world->meshes) {
    if (!instance.collides || instance.surface != SurfaceClass::kCanopy) continue;
    const Vector3d o = instance.mesh->vertices[0].cast<double>();
    for (const auto& [a, b, c] : instance.mesh->triangles) {
      const auto at = [&](std::uint32_t v) -> Vector3d {
        return instance.mesh->vertices[v].cast<double>() - o;
      };
      volume_m3 += at(a).dot(at(b).cross(at(c))) / 6.0;
    }
  }
  EXPECT_NEAR(truth.volume_m3, volume_m3, 0.003 * volume_m3);
  EXPECT_NEAR(truth.spacing_m, 2.5, 0.002);  // chords of 1 m lie 1.6 mm inside their arcs
  for (const RowTruth& row : truth.rows) {
    // Hulls begin where their vines' half spacing does, and end in a tip.
    EXPECT_NEAR(row.length_m, 27.0, 1.6);
    EXPECT_NEAR(row.canopy_top_m, 2.0, 0.1);
    EXPECT_NEAR(row.canopy_base_m, 0.55, 0.1);
    EXPECT_NEAR(row.canopy_width_m, 0.55, 0.06);
    EXPECT_TRUE(row.gaps_m.empty());
  }
}

class TruthFile : public ::testing::Test {
 protected:
  std::filesystem::path file_ =
      std::filesystem::path(VINEROW_BINARY_DIR) / "scratch" /
      (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".json");
  void SetUp() override { std::filesystem::create_directories(file_.parent_path()); }
  void TearDown() override { std::filesystem::remove(file_); }
  std::string refusal() const {
    try {
      read_cloud_truth(file_);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(TruthFile, ReadsBackWhatWasWritten) {
  const WorldModel world = two_rows();
  const physics::WorldScene scene(world);
  CloudTruth truth = measure_truth(scene, world);
  truth.scenario = "boxes";
  truth.origin = {0.1234567890123, -0.7, 301.25};
  truth.sampling.method = "photogrammetry";
  truth.sampling.seed = 18446744073709551615ull;
  truth.sampling.points = 60'000'000'001;
  truth.sampling.height_noise_rms_m = 0.1 / 3.0;
  write_cloud_truth(truth, file_);
  const CloudTruth back = read_cloud_truth(file_);
  EXPECT_EQ(back.scenario, "boxes");
  EXPECT_EQ(back.world, "level");
  EXPECT_NEAR(back.origin.latitude_rad, truth.origin.latitude_rad, 1e-15);
  EXPECT_EQ(back.origin.altitude_m, 301.25);
  EXPECT_EQ(back.boundary_W, truth.boundary_W);
  EXPECT_EQ(back.sampling.seed, truth.sampling.seed);
  EXPECT_EQ(back.sampling.points, truth.sampling.points);
  EXPECT_EQ(back.sampling.height_noise_rms_m, truth.sampling.height_noise_rms_m);
  ASSERT_EQ(back.rows.size(), truth.rows.size());
  for (std::size_t k = 0; k < back.rows.size(); ++k) {
    const RowTruth &a = back.rows[k], &b = truth.rows[k];
    EXPECT_EQ(a.row, b.row);
    EXPECT_EQ(a.line_W, b.line_W);
    EXPECT_EQ(a.first_W, b.first_W);
    EXPECT_EQ(a.last_W, b.last_W);
    EXPECT_EQ(a.length_m, b.length_m);
    EXPECT_EQ(a.bearing_deg, b.bearing_deg);
    EXPECT_EQ(a.spacing_m, b.spacing_m);
    EXPECT_EQ(a.canopy_base_m, b.canopy_base_m);
    EXPECT_EQ(a.canopy_top_m, b.canopy_top_m);
    EXPECT_EQ(a.canopy_width_m, b.canopy_width_m);
    EXPECT_EQ(a.volume_m3, b.volume_m3);
    EXPECT_EQ(a.gaps_m, b.gaps_m);
  }
}

TEST_F(TruthFile, RefusesWhatIsNone) {
  EXPECT_EQ(refusal(), "'" + file_.string() + "' cannot be read");
  std::ofstream(file_) << "{\"scenario\": \"x\"}";
  EXPECT_NE(refusal().find("is not a truth file of a cloud"), std::string::npos) << refusal();
  EXPECT_NE(refusal().find("'world' not found"), std::string::npos) << refusal();
  std::ofstream(file_) << "LASF";
  EXPECT_NE(refusal().find("is not a truth file of a cloud"), std::string::npos) << refusal();
}

TEST(TruthFileName, StandsBesideTheCloud) {
  EXPECT_EQ(truth_file_of("a/b.c/parcel.las"), "a/b.c/parcel.truth.json");
}

}  // namespace
}  // namespace vinerow::mapping::cloud_truth_test
