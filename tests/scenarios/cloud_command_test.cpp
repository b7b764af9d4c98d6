/// `vinerow cloud` as a user meets it, and the scenarios whose surveys it is made for.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/api/world_model.h"
#include "engine/io/clouds/point_cloud.h"
#include "engine/io/clouds/point_cloud_crs.h"
#include "tests/scenarios/command.h"
#include "worlds/mapping/photogrammetry/cloud_truth.h"

namespace vinerow::test::cloud_command_test {
namespace {

using ::testing::HasSubstr;

/// Parcel F cut down to what is sampled in a second.
const std::string kSmall =
    scenario_file("map_parcel") + " --set world.row_count=4 --set world.row_length_m=40";

std::vector<io::CloudPoint> read_points(const std::filesystem::path& file) {
  const auto reader = io::open_point_cloud(file);
  std::vector<io::CloudPoint> points(reader->info().record_count.value_or(1'000'000));
  points.resize(reader->read(points));
  return points;
}

TEST(CloudCommand, TakesTheFlownSurveyAndKeepsTheTruth) {
  const ScratchFolder folder("cloud_flown");
  const std::string run = (folder.path() / "run").string();
  const CommandResult flight = run_vinerow("run " + kSmall + " --quiet --out " + run);
  ASSERT_EQ(flight.status, 0) << flight.output;

  const std::string out = (folder.path() / "new" / "small.las").string();
  const std::string ask = "cloud " + kSmall + " --density 50 --log " + run;
  const CommandResult result = run_vinerow(ask + " --out " + out);
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("plane/camera of " + run + "/log.mcap"));
  EXPECT_THAT(result.output,
              HasSubstr("truth          4 rows, bearing 80.000 deg, spacing 2.500 m"));
  const mapping::CloudTruth truth =
      mapping::read_cloud_truth(folder.path() / "new/small.truth.json");
  const std::vector<io::CloudPoint> points = read_points(out);
  EXPECT_EQ(points.size(), static_cast<std::size_t>(truth.sampling.points));
  EXPECT_EQ(
      value_in("\n" + result.output, "points").substr(0, std::to_string(points.size()).size()),
      std::to_string(points.size()));
  EXPECT_EQ(truth.sampling.method, "photogrammetry");
  EXPECT_EQ(truth.sampling.crs, "");
  EXPECT_NEAR(truth.sampling.gsd_m, 0.026, 0.0005);
  EXPECT_NEAR(truth.sampling.area_m2, 60.0 * 12.5, 2.0);
  EXPECT_NEAR(truth.sampling.density_per_m2, 50.0, 2.0) << "a few are hidden behind the rows";
  EXPECT_GT(truth.sampling.height_noise_rms_m, 0.013) << "half a pixel and a thin baseline";
  EXPECT_LT(truth.sampling.height_noise_rms_m, 0.04);
  EXPECT_EQ(truth.scenario, "map_parcel");
  for (const io::CloudPoint& point : points) {
    EXPECT_TRUE(point.rgb.has_value());
    EXPECT_EQ(point.classification.value_or(0), 0) << "truth must be asked for";
  }

  // The same bits again, without the scenario, and in another order of options.
  const std::string again = (folder.path() / "again.las").string();
  const CommandResult second =
      run_vinerow("cloud --log " + run + "/log.mcap --out " + again + " --density 50");
  ASSERT_EQ(second.status, 0) << second.output;
  EXPECT_EQ(read_text(again), read_text(out));
  // Another seed, other bits.
  ASSERT_EQ(run_vinerow(ask + " --seed 5 --out " + again).status, 0);
  EXPECT_NE(read_text(again), read_text(out));
  // What is set is set over the log's scenario as over the file.
  const std::string lower = " --set world.canopy_top_m=1.7 --density 50 --log " + run + " --out ";
  ASSERT_EQ(run_vinerow("cloud" + lower + again).status, 0);
  const auto volume_m3 = [&](const std::string& file) {
    return mapping::read_cloud_truth(folder.path() / file).volume_m3;
  };
  EXPECT_LT(volume_m3("again.truth.json"), 0.95 * truth.volume_m3);
  ASSERT_EQ(run_vinerow("cloud " + kSmall + lower + (folder.path() / "named.las").string()).status,
            0);
  EXPECT_EQ(volume_m3("again.truth.json"), volume_m3("named.truth.json"));
  const CommandResult wrong = run_vinerow("cloud" + lower + again + " --set world.canopy_tip_m=1");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.output, HasSubstr("did you mean 'canopy_top_m'?"));

  const CommandResult nobody = run_vinerow(ask + " --vehicle kite --out " + again);
  EXPECT_EQ(nobody.status, 2);
  EXPECT_THAT(nobody.output, HasSubstr("camera 'kite/*' took no picture; cameras that did: "
                                       "plane/camera"));
}

TEST(CloudCommand, GeoreferencedPointsLieWhereLocalOnesDo) {
  const ScratchFolder folder("cloud_crs");
  const std::string local = (folder.path() / "local.ply").string();
  const std::string utm = (folder.path() / "utm.las").string();
  const std::string ask = "cloud " + kSmall + " --density 20 --truth-classes --out ";
  const CommandResult result = run_vinerow(ask + local);
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("plan of "));
  ASSERT_EQ(run_vinerow(ask + utm + " --crs EPSG:32632").status, 0);
  const std::vector<io::CloudPoint> a = read_points(local), b = read_points(utm);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(io::open_point_cloud(utm)->info().crs, "EPSG:32632");
  const mapping::CloudTruth truth = mapping::read_cloud_truth(folder.path() / "utm.truth.json");
  const io::CloudFrame frame("EPSG:32632", truth.origin);
  int ground = 0, canopy = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    // LAS rounds to 1 mm along each axis.
    EXPECT_LT((frame.to_local(b[k].position) - a[k].position).norm(), 1.1e-3);
    EXPECT_EQ(a[k].rgb, b[k].rgb);
    EXPECT_EQ(a[k].classification, b[k].classification);
    ground += a[k].classification == 2 ? 1 : 0;
    canopy += a[k].classification == 5 ? 1 : 0;
  }
  EXPECT_EQ(ground, truth.sampling.ground_points);
  EXPECT_EQ(canopy, truth.sampling.canopy_points);
  EXPECT_EQ(static_cast<std::size_t>(ground + canopy), a.size());
}

TEST(CloudCommand, SpreadsPointsEvenlyWithoutPictures) {
  const ScratchFolder folder("cloud_uniform");
  const std::string out = (folder.path() / "even.xyz").string();
  const CommandResult result = run_vinerow(
      "cloud " + kSmall + " --uniform 20 --noise 0.05 --weeds 0.5 --outliers 0.02 --out " + out +
      " --area 66 34 78 34 78 44 66 44 --margin 1");
  ASSERT_EQ(result.status, 0) << result.output;
  const mapping::CloudTruth truth = mapping::read_cloud_truth(folder.path() / "even.truth.json");
  EXPECT_EQ(truth.sampling.method, "uniform");
  EXPECT_EQ(truth.sampling.noise_m, 0.05);
  EXPECT_EQ(truth.sampling.weeds_m, 0.5);
  EXPECT_NEAR(truth.sampling.area_m2, 12 * 10 + 2 * 22 + 3.14, 0.5) << "a margin has round corners";
  EXPECT_GT(truth.sampling.outlier_points, 0);
  EXPECT_EQ(read_points(out).size(), static_cast<std::size_t>(truth.sampling.points));
}

TEST(CloudCommand, RefusesInASentence) {
  const ScratchFolder folder("cloud_refused");
  const std::string out = " --out " + (folder.path() / "x.las").string();
  const auto refused = [&](const std::string& arguments) {
    const CommandResult result = run_vinerow("cloud " + arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "x.truth.json"));
    return result.output;
  };
  EXPECT_THAT(refused(out), HasSubstr("give a scenario, or a flown survey with --log"));
  EXPECT_THAT(refused(kSmall + " --out x.laz"), HasSubstr("'x.laz' must end in .las, .ply, .xyz"));
  EXPECT_THAT(refused(kSmall + out + " --density 0"),
              HasSubstr("--density: density_per_m2 = 0 1/m2, must be >= 0.001 1/m2 and <= "));
  EXPECT_THAT(refused(kSmall + out + " --uniform -5"),
              HasSubstr("density is -5 points per square metre, must be above 0"));
  EXPECT_THAT(refused(kSmall + out + " --uniform 5 --density 3"),
              HasSubstr("--uniform uses no pictures"));
  EXPECT_THAT(refused(kSmall + out + " --weeds 0.5"), HasSubstr("need --uniform"));
  EXPECT_THAT(refused(kSmall + out + " --area 0 0 1 0 1"), HasSubstr("--area: 5 numbers"));
  EXPECT_THAT(refused(kSmall + out + " --uniform 5 --area 5000 0 5010 0 5010 10"),
              HasSubstr("no point: the world has no surface in the area"));
  EXPECT_THAT(refused(kSmall + out + " --area 5000 0 5010 0 5010 10"),
              HasSubstr("pictures shows the cloud's area"));
  EXPECT_THAT(refused(kSmall + out + " --crs EPSG:77"), HasSubstr("EPSG:77"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "x.las"))
      << "what could not be made is not left behind";
  EXPECT_THAT(refused(scenario_file("vineyard_rover") + out),
              HasSubstr("no vehicle has the planner 'survey'"));
}

TEST(CloudCommand, ARunWithoutPicturesIsNoSurvey) {
  const ScratchFolder folder("cloud_no_survey");
  const std::string run = (folder.path() / "run").string();
  const CommandResult flight =
      run_vinerow("run " + kSmall + " --set duration_s=1 --set criteria=[] --quiet --out " + run);
  ASSERT_EQ(flight.status, 0) << flight.output;
  const CommandResult result = run_vinerow("cloud " + kSmall + " --log " + run + " --out " +
                                           (folder.path() / "x.las").string());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.output, HasSubstr("contains no survey: no camera_trigger of the run took a "
                                       "picture"));
}

class MapSurvey : public ::testing::TestWithParam<const char*> {};

TEST_P(MapSurvey, IsFlownWithAllCriteriaMet) {
  const ScratchFolder folder(std::string("cloud_") + GetParam());
  const CommandResult flight = run_vinerow("run " + scenario_file(GetParam()) + " --quiet --out " +
                                           (folder.path() / "run").string());
  EXPECT_EQ(flight.status, 0) << flight.output;
}
INSTANTIATE_TEST_SUITE_P(All, MapSurvey,
                         ::testing::Values("map_parcel", "map_curved", "map_riseholme"),
                         [](const auto& parameter) { return std::string(parameter.param); });

}  // namespace
}  // namespace vinerow::test::cloud_command_test
