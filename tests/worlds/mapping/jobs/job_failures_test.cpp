/// Jobs that cannot do what they are asked: while loading by ConfigError, while running by a
/// reason.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/worlds/mapping/jobs/job_fixture.h"

namespace vinerow::job_failures_test {
namespace {

using test::job_parameters;
using test::ScratchFolder;
using ::testing::HasSubstr;

class JobFailures : public ::testing::Test {
 protected:
  std::string refused(const std::string& type, const ParameterSet& parameters) const {
    return test::config_error_of(
        [&] { test::all_parts().make_job(type, parameters, test::job_context(folder_.path())); });
  }
  std::string reason(const std::string& type, const ParameterSet& parameters,
                     const std::map<std::string, Product>& inputs) const {
    const auto outcome = test::run_job(type, parameters, folder_.path() / "out", inputs);
    return outcome ? "no failure" : outcome.reason();
  }
  const WorldModel& world() const { return *test::surveyed_world("vineyard").model; }
  const ScratchFolder folder_{"job_failures"};
};

TEST_F(JobFailures, PhotogrammetryIsRefusedWhileLoading) {
  const auto with = [](const char* key, ParameterSet::Value value) {
    ParameterSet parameters = job_parameters("photogrammetry");
    parameters.set(key, std::move(value));
    return parameters;
  };
  EXPECT_EQ(refused("photogrammetry", with("max_views", std::int64_t(2))),
            "min_views = 3, must be <= max_views = 2");
  EXPECT_THAT(refused("photogrammetry", with("crs", std::string("foo"))),
              HasSubstr("crs = 'foo' is not a coordinate reference system"));
  EXPECT_EQ(refused("photogrammetry", with("missing_rows", std::vector<double>{1, 4})),
            "world 'vineyard' has no row 4, its rows are 0 to 3");
  EXPECT_EQ(refused("photogrammetry", with("missing_rows", std::vector<double>{1.5})),
            "missing_rows[0] = 1.5, must be a whole number");
  EXPECT_EQ(refused("photogrammetry", with("area_m", std::vector<double>{0, 0, 1})),
            "area_m: 3 numbers, must be an even number: x and y of each corner in m");
  EXPECT_EQ(test::config_error_of([&] { with("match_noise_px", -0.5); }),
            "match_noise_px = -0.5 px, must be >= 0 px and <= 100 px");
  EXPECT_EQ(test::config_error_of([&] { with("min_views", std::int64_t(1)); }),
            "min_views = 1, must be >= 2 and <= 1000");
}

TEST_F(JobFailures, PhotogrammetryFailsWithoutPicturesOfTheParcel) {
  EXPECT_EQ(reason("photogrammetry", test::thin_photogrammetry(),
                   test::pictures_input(test::pictures_of(world(), 90.0))),
            "none of the 25 pictures shows the cloud's area");
  auto none = std::make_shared<PictureSet>();
  none->source = "plane/camera";
  EXPECT_EQ(reason("photogrammetry", test::thin_photogrammetry(), test::pictures_input(none)),
            "camera 'plane/camera' has taken no picture");
  auto two = std::make_shared<PictureSet>(*test::pictures_of(world()));
  two->X_WS.resize(2);
  EXPECT_THAT(reason("photogrammetry", test::thin_photogrammetry(), test::pictures_input(two)),
              HasSubstr("no point: the world has no surface in the area, or too few pictures see "
                        "it ("));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out" / "cloud.las"));
}

TEST_F(JobFailures, CloudMapIsRefusedWhileLoading) {
  ParameterSet parameters = job_parameters("cloud_map");
  parameters.set("row_spacing_m", std::vector<double>{3, 2});
  EXPECT_EQ(refused("cloud_map", parameters), "row_spacing_m = [3, 2], must rise");
  for (const char* crs : {"", "none", "EPSG:25832"}) {
    ParameterSet known = job_parameters("cloud_map");
    known.set("crs", std::string(crs));
    EXPECT_EQ(test::config_error_of([&] {
                test::all_parts().make_job("cloud_map", known, test::job_context(folder_.path()));
              }),
              "no error")
        << crs;
  }
  ParameterSet unknown = job_parameters("cloud_map");
  unknown.set("crs", std::string("EPSG:99999"));
  EXPECT_THAT(refused("cloud_map", unknown),
              HasSubstr("crs = 'EPSG:99999' is not a coordinate reference system"));
  WorldModel field;
  field.name = "field";
  JobContext context = test::job_context(folder_.path());
  context.world = &field;
  EXPECT_EQ(test::config_error_of([&] {
              test::all_parts().make_job("cloud_map", job_parameters("cloud_map"), context);
            }),
            "boundary: world 'field' has no parcel, must be none");
}

TEST_F(JobFailures, CloudMapFailsWhereThereAreNoRows) {
  ParameterSet bare = test::thin_photogrammetry();
  bare.set("missing_rows", std::vector<double>{0, 1, 2, 3});
  const std::map<std::string, Product> inputs = {
      {"cloud", test::make_cloud(folder_.path() / "bare", bare)}};
  EXPECT_EQ(reason("cloud_map", job_parameters("cloud_map"), inputs),
            "no rows found: nothing is more than 0.55 m above the ground");
  Product nowhere;
  nowhere.kind = ProductKind::kCloud;
  nowhere.file = folder_.path() / "gone.las";
  EXPECT_THAT(reason("cloud_map", job_parameters("cloud_map"), {{"cloud", nowhere}}),
              HasSubstr("gone.las"));
}

TEST_F(JobFailures, PlanPassesOnWhyThereIsNone) {
  ParameterSet parameters = job_parameters("plan");
  EXPECT_THAT(test::config_error_of([&] { parameters.require_complete(); }), HasSubstr("vehicle"));
  parameters.set("vehicle", std::string("lost"));
  EXPECT_EQ(reason("plan", parameters, {}), "no way out of alley 3");
}

}  // namespace
}  // namespace vinerow::job_failures_test
