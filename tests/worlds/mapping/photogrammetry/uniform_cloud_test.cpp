#include "worlds/mapping/photogrammetry/uniform_cloud.h"
#include "engine/api/map.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "tests/worlds/mapping/photogrammetry/cloud_scene.h"

namespace vinerow::mapping::uniform_cloud_test {
namespace {

using Eigen::Vector3d;

struct Sampled {
  test::Collected cloud;
  CloudTally tally;
};

Sampled sample(const WorldModel& world, double half_m, const UniformCloudOptions& options) {
  Sampled made;
  made.tally =
      sample_uniformly(world, SurveyArea(test::square(half_m), 0.0), options, made.cloud.sink());
  EXPECT_EQ(made.tally.points, static_cast<std::int64_t>(made.cloud.points.size()));
  return made;
}

TEST(UniformCloud, EverySquareMetreOfSurfaceHasItsPoints) {
  const WorldModel world = test::level_world(50.0, {test::box({-2, -1, 0.5}, {2, 1, 2.0})});
  UniformCloudOptions options;
  options.density_per_m2 = 900.0;
  const Sampled made = sample(world, 5.0, options);
  int ground = 0, top = 0, bottom = 0, sides = 0;
  for (const SampledPoint& point : made.cloud.points) {
    const Vector3d& p = point.p_W;
    if (p.z() == 0.0)
      ++ground;
    else if (p.z() == 2.0)
      ++top;
    else if (p.z() == 0.5)
      ++bottom;
    else
      ++sides;
  }
  EXPECT_NEAR(ground, 900 * 100, 0.01 * 900 * 100) << "also below the box";
  // The area times the density, a triangle's count rounded up or down by chance.
  EXPECT_NEAR(top, 900 * 8, 2);
  EXPECT_NEAR(bottom, 900 * 8, 2);
  EXPECT_NEAR(sides, 900 * 18, 8);
  EXPECT_EQ(made.tally.horizontal_rms_m(), 0.0);
}

TEST(UniformCloud, SteepGroundHasMorePoints) {
  WorldModel world = test::level_world(50.0, {});
  HeightField& ground = *world.terrain;
  for (int k = 0; k < 121; ++k) {  // 3 m up in 4 m to the east: a quarter more surface than plan
    ground.heights_m[static_cast<std::size_t>(k)] = static_cast<float>(7.5 * (k % 11));
  }
  UniformCloudOptions options;
  options.density_per_m2 = 300.0;
  const auto count = static_cast<double>(sample(world, 10.0, options).cloud.points.size());
  EXPECT_NEAR(count, 300.0 * 400.0 * 1.25, 0.01 * count);
}

TEST(UniformCloud, NoiseIsTheSameAlongAllAxes) {
  const WorldModel world = test::level_world(50.0, {});
  UniformCloudOptions options;
  options.noise_m = 0.05;
  const Sampled made = sample(world, 10.0, options);  // 80000 points: 0.25 % of a deviation
  EXPECT_NEAR(made.tally.height_rms_m(), 0.05, 0.0007);
  EXPECT_NEAR(made.tally.horizontal_rms_m(), 0.05 * std::sqrt(2.0), 0.0007);
  double sum = 0.0;
  for (const SampledPoint& point : made.cloud.points) sum += point.p_W.z() * point.p_W.z();
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(made.cloud.points.size())),
              made.tally.height_rms_m(), 1e-9);
}

TEST(UniformCloud, WeedsGrowBetweenRowsUpToTheirHeight) {
  WorldModel world = test::level_world(50.0, {});
  PlantRow row;
  row.line_W = {{-20, 0, 0}, {20, 0, 0}};
  world.rows->rows.push_back(row);
  UniformCloudOptions options;
  options.weeds.height_m = 0.5;
  const Sampled made = sample(world, 15.0, options);
  double highest = 0.0, nearest = 100.0;
  int weeds = 0;
  for (const SampledPoint& point : made.cloud.points) {
    const bool is_weed = point.truth == PointClass::kLowVegetation;
    EXPECT_EQ(is_weed, point.p_W.z() > 0.0);
    if (!is_weed) continue;
    ++weeds;
    highest = std::max(highest, point.p_W.z());
    nearest = std::min(nearest, std::abs(point.p_W.y()));
  }
  EXPECT_LE(highest, 0.5);
  EXPECT_GT(highest, 0.4);
  EXPECT_GE(nearest, options.weeds.offset_from_rows_m);
  // Tufts cover 0.5 E[pi R^2] = 8.7 % of the ground, overlaps and the free strip taken off.
  const double share = weeds / static_cast<double>(made.cloud.points.size());
  EXPECT_GT(share, 0.06);
  EXPECT_LT(share, 0.09);
}

TEST(UniformCloud, OutliersAreTheirShare) {
  const WorldModel world = test::level_world(50.0, {});
  UniformCloudOptions options;
  options.outliers = 0.1;
  const Sampled made = sample(world, 10.0, options);
  const double count = static_cast<double>(made.cloud.points.size());
  EXPECT_NEAR(static_cast<double>(made.tally.outliers), 0.1 * count, 0.005 * count);
  int off = 0;
  for (const SampledPoint& point : made.cloud.points) {
    off += point.p_W.z() != 0.0 ? 1 : 0;
    EXPECT_GE(point.p_W.z(), -2.0);
    EXPECT_LE(point.p_W.z(), 8.0);
  }
  EXPECT_EQ(off, made.tally.outliers);
}

TEST(UniformCloud, TheSameSeedGivesTheSameBits) {
  const WorldModel world = test::level_world(50.0, {test::box({-2, -1, 0.5}, {2, 1, 2.0})});
  UniformCloudOptions options;
  options.noise_m = 0.02;
  options.weeds.height_m = 0.3;
  options.outliers = 0.01;
  const Sampled one = sample(world, 12.0, options);
  EXPECT_TRUE(sample(world, 12.0, options).cloud == one.cloud);
  options.seed = 9;
  EXPECT_FALSE(sample(world, 12.0, options).cloud == one.cloud);
}

TEST(UniformCloud, RefusesWhatCannotBe) {
  const WorldModel world = test::level_world(50.0, {});
  const auto refused = [&](const UniformCloudOptions& options) -> std::string {
    try {
      sample(world, 1.0, options);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  UniformCloudOptions options;
  options.noise_m = -1.0;
  EXPECT_EQ(refused(options), "the noise of points is -1, must be 0 to 10 m");
  options = {};
  options.weeds.height_m = 11.0;
  EXPECT_EQ(refused(options), "the height of weeds is 11, must be 0 to 10 m");
  options = {};
  options.outliers = 1.5;
  EXPECT_EQ(refused(options), "the share of outliers is 1.5, must be 0 to 1");
  options = {};
  options.density_per_m2 = -3.0;
  EXPECT_EQ(refused(options),
            "the cloud's density is -3 points per square metre, must be above 0 and at most "
            "1000000");
}

}  // namespace
}  // namespace vinerow::mapping::uniform_cloud_test
