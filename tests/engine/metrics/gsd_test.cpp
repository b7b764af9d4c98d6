/// The reported ground sampling distance against the data sheet's numbers: by the formula at the
/// height flown, and by the images of two ground points in a pinhole camera.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "engine/math/angles.h"
#include "engine/metrics/survey_coverage.h"
#include "engine/sensors/camera_trigger.h"
#include "tests/engine/sensors/sensor_bench.h"

namespace vinerow::metrics::gsd_test {
namespace {

using Eigen::Vector3d;

// MicaSense RedEdge, paper A, section 2: pixels of 3.75 um (4.8 mm / 1280), lens of 5.4 mm.
constexpr double kPitch_m = 3.75e-6, kFocal_m = 5.4e-3, kHalfColumns = 640.0;

class GsdBench : public ::testing::Test {
 protected:
  GsdBench() {
    plane_.fixed_wing.emplace();
    ParameterSet camera(sensors::camera_trigger_spec().parameters, "camera_trigger");
    camera.set("on", std::string("always"));
    // Upright at the nose's 7.35 deg up in level flight, as in the shipped surveys.
    camera.set("rotation_deg", std::vector<double>{0.0, 97.35, 0.0});
    camera_ = sensors::make_camera_trigger(camera, bench_.context(20.0));
    bench_.connect(*camera_);
    ParameterSet survey(survey_coverage_spec().parameters, "survey");
    survey.set("camera", std::string("s"));
    survey.set("polygon_x_m", std::vector<double>{0, 700, 700, 0});
    survey.set("polygon_y_m", std::vector<double>{-40, -40, 40, 40});
    MetricContext context;
    context.vehicle_description = &plane_;
    context.world = &bench_.world;
    metric_ = make_survey_coverage(survey, context);
    Ports ports(bench_.bus, "rover", "rover.metrics.survey");
    metric_->connect(ports);
    shot_ = bench_.bus.subscribe<CameraShot>("rover/s", "test");
  }
  /// 50 ms. @param attitude  beside the trim's. @returns whether it took a picture
  bool fly(const Vector3d& p_W, const RollPitchYaw& attitude = {}) {
    Odometry truth;
    truth.X_WB = {
        quaternion_from_rpy(attitude) * quaternion_from_rpy({0.0, rad_from_deg(-7.35), 0.0}), p_W};
    truth.v_WB_B = {12, 0, 0};
    bench_.truth.write(now_, truth);
    camera_->step(now_);
    metric_->step(now_);
    now_ = now_ + Duration{50'000'000};
    return shot_.is_newer_than(seen_);
  }
  /// Column of the last picture in which a pinhole camera sees a place of W, from its left edge.
  double column(const Vector3d& p_W) const {
    const Vector3d p_S = shot_.value().X_WS.inverse() * p_W;
    return kHalfColumns - kFocal_m / kPitch_m * p_S.y() / p_S.x();
  }
  Vector3d on_ground(double x, double y) const { return {x, y, bench_.scene.plane->rise_x * x}; }

  test::SensorBench bench_;
  VehicleDescription plane_;
  std::unique_ptr<Sensor> camera_;
  std::unique_ptr<Metric> metric_;
  SignalReader<CameraShot> shot_;
  std::uint64_t seen_ = 0;
  Time now_;
};

TEST_F(GsdBench, TheMeanIsTheFormulasAtTheHeightFlown) {
  bench_.scene.plane->rise_x = 0.08;
  double height_sum_m = 0.0;
  int shots = 0;
  for (int i = 0; i < 1200; ++i) {  // 60 s uphill, ramps 2 m high and low, gusts roll and pitch it
    const double t = 0.05 * i, x = 12.0 * t, height_m = 150.0 + 2.0 * std::sin(0.11 * t);
    const RollPitchYaw attitude{rad_from_deg(5.0) * std::sin(1.7 * t),
                                rad_from_deg(2.0) * std::cos(2.3 * t), 0.0};
    if (!fly({x, 0, 0.08 * x + height_m}, attitude)) continue;
    height_sum_m += height_m;
    ++shots;
  }
  const std::map<std::string, double> results = metric_->results();
  ASSERT_EQ(results.at("shots"), shots);
  ASSERT_GT(shots, 55);
  const double formula_m = height_sum_m / shots * kPitch_m / kFocal_m;
  EXPECT_NEAR(results.at("gsd_mean_m"), formula_m, 0.01 * formula_m);
  RecordProperty("difference_percent",
                 std::to_string(100.0 * (results.at("gsd_mean_m") / formula_m - 1.0)));
}

TEST_F(GsdBench, PlacesOneGsdApartAreOnePixelApart) {
  bench_.scene.plane->rise_x = 0.08;
  const RollPitchYaw attitude{0.0, rad_from_deg(4.0), 0.0};
  ASSERT_TRUE(fly({100, 20, 140}, attitude));
  const double gsd_m = shot_.value().gsd_m;
  const Vector3d middle =
      shot_.value().X_WS * Vector3d(shot_.value().distance_m, 0.0, 0.0);  // what it looks at
  EXPECT_NEAR(middle.z(), 0.08 * middle.x(), 1e-9);
  EXPECT_NEAR(column(middle), kHalfColumns, 1e-9);
  // Across the track the ground is level: exactly, at the middle as towards the edge.
  for (const double y : {20.0, 30.0, -35.0}) {
    EXPECT_NEAR(column(on_ground(middle.x(), y - gsd_m)) - column(on_ground(middle.x(), y)), 1.0,
                1e-9);
  }
}

TEST_F(GsdBench, BankedByFiveDegreesItIsOnePixelWithinOnePercent) {
  ASSERT_TRUE(fly({100, 20, 150}, {rad_from_deg(5.0), 0.0, 0.0}));
  const Vector3d middle = shot_.value().X_WS * Vector3d(shot_.value().distance_m, 0.0, 0.0);
  const double pixels =
      column(on_ground(middle.x(), middle.y() - shot_.value().gsd_m)) - column(middle);
  // The ground lies aslant to the picture: cos(5 deg) of a pixel.
  EXPECT_NEAR(pixels, std::cos(rad_from_deg(5.0)), 1e-4);
  EXPECT_NEAR(pixels, 1.0, 0.01);
}

}  // namespace
}  // namespace vinerow::metrics::gsd_test
