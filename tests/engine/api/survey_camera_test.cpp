#include "engine/api/survey_camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"

namespace vinerow::survey_camera_test {
namespace {

SurveyCamera camera_of(const std::string& name) {
  ParameterSet parameters(survey_camera_parameters(), "survey");
  parameters.set("camera", name);
  return read_survey_camera(parameters);
}

// Paper A, section 2, with the corrections of its reference.
TEST(SurveyCamera, TellsThePaperGroundSamplingDistances) {
  EXPECT_NEAR(camera_of("rededge").gsd_m(150.0), 0.1042, 5e-5);
  EXPECT_NEAR(camera_of("rededge_5p5").gsd_m(150.0), 0.1023, 5e-5);
  EXPECT_NEAR(camera_of("rx100").gsd_m(150.0), 0.0411, 5e-5);
  EXPECT_NEAR(camera_of("rededge").height_for_gsd_m(0.041), 59.04, 1e-9);
}

TEST(SurveyCamera, FootprintAndOverlapsFollowTheHeight) {
  const SurveyCamera camera = camera_of("rededge");
  EXPECT_NEAR(camera.footprint_width_m(150.0), 400.0 / 3.0, 1e-9);
  EXPECT_NEAR(camera.footprint_length_m(150.0), 100.0, 1e-9);
  EXPECT_NEAR(camera.forward_overlap(150.0, 15.0), 0.85, 1e-12);
  EXPECT_NEAR(camera.forward_overlap(150.0, 12.0), 0.88, 1e-12);
  EXPECT_NEAR(camera.side_overlap(150.0, 45.0), 0.6625, 1e-12);
  // 41 mm at 12 m/s and 1 Hz: 69.5 %.
  EXPECT_NEAR(camera.forward_overlap(camera.height_for_gsd_m(0.041), 12.0), 0.695, 5e-4);
  EXPECT_LT(camera.side_overlap(10.0, 45.0), 0.0);
}

TEST(SurveyCamera, AnglesOfViewSpanTheFootprint) {
  const SurveyCamera camera = camera_of("rx100");
  EXPECT_NEAR(2.0 * 80.0 * std::tan(camera.half_angle_across_rad()), camera.footprint_width_m(80.0),
              1e-9);
  EXPECT_NEAR(2.0 * 80.0 * std::tan(camera.half_angle_along_rad()), camera.footprint_length_m(80.0),
              1e-9);
}

TEST(SurveyCamera, NumbersReplaceThePreset) {
  ParameterSet parameters(survey_camera_parameters(), "survey");
  parameters.set("camera", std::string("rx100"));
  parameters.set("focal_length_mm", 10.4);  // 34.8 mm at 150 m
  parameters.set("max_rate_Hz", 2.5);
  parameters.set("image_rows", std::int64_t{1000});
  const SurveyCamera camera = read_survey_camera(parameters);
  EXPECT_NEAR(camera.gsd_m(150.0), 0.0348, 5e-5);
  EXPECT_EQ(camera.max_rate_Hz, 2.5);
  EXPECT_EQ(camera.rows, 1000);
  EXPECT_EQ(camera.columns, 5472);
  EXPECT_THROW(parameters.set("focal_length_mm", 0.0), ConfigError);
  EXPECT_THROW(parameters.set("image_columns", std::int64_t{0}), ConfigError);
}

}  // namespace
}  // namespace vinerow::survey_camera_test
