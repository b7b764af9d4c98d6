/// Which echoes the HC-SR04 of assets/sensors hears, against measurements of a real one.

#include "engine/sensors/echo.h"
#include "engine/api/messages/sensors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"
#include "tests/engine/sensors/ranging_bench.h"
#include "tests/support/plain_scene.h"

namespace vinerow::sensors::echo_test {
namespace {

using test::Panel;
using test::PlainScene;
using Bench = test::RangingBench<RangeSample>;

constexpr auto kSmooth = SurfaceClass::kObstacle;

scenario::PartConfig hc_sr04() {
  // Many rays: these tests are of the model, not of the bundle.
  return test::data_sheet(
      "hc_sr04", {{"missed_share", 0.0}, {"false_share", 0.0}, {"rings", std::int64_t{40}}});
}

bool hears(const PlainScene& scene) {
  Bench bench(hc_sr04(), scene);
  return std::isfinite(bench.step().range_m);
}

/// A smooth wall whose nearest point is `distance_m` away, `aslant_deg` left of x.
PlainScene wall(double distance_m, double aslant_deg, SurfaceClass surface) {
  const double a = rad_from_deg(aslant_deg);
  const Eigen::Vector3d direction(std::cos(a), std::sin(a), 0.0);
  PlainScene scene;
  scene.panels.push_back({distance_m * direction, -direction, surface});
  return scene;
}

/// A smooth panel that faces the sensor.
PlainScene panel(double distance_m, double width_m, double height_m, double aside_m = 0.0) {
  PlainScene scene;
  scene.panels.push_back(
      {{distance_m, aside_m, 0.0}, {-1.0, 0.0, 0.0}, kSmooth, 0.5 * width_m, 0.5 * height_m});
  return scene;
}

TEST(HcSr04, ReadsItsFile) {
  const scenario::PartConfig part = test::data_sheet("hc_sr04");
  EXPECT_EQ(part.type, "ultrasound");
  EXPECT_EQ(part.rate_Hz, 20.0);
  EXPECT_EQ(part.parameters.number("accuracy_m"), 0.003);
  EXPECT_EQ(part.parameters.number("max_range_m"), 4.0);
  for (const ParameterSpec& spec : part.parameters.specs()) {
    if (!part.parameters.source(spec.name).empty()) continue;
    // What the file does not say with a source is the place, the law of noise, or left as it is.
    const ParameterSet plain = test::sensor_parameters("ultrasound", {});
    if (spec.kind == ParameterKind::kNumber) {
      EXPECT_EQ(part.parameters.number(spec.name), plain.number(spec.name)) << spec.name;
    }
  }
}

TEST(HcSr04, HearsAWallInFrontOutToItsRange) {
  EXPECT_TRUE(hears(wall(0.3, 0.0, kSmooth)));
  EXPECT_TRUE(hears(wall(3.98, 0.0, kSmooth)));
}

// Dyrkacz 2020: aimed targets. The smallest plate had stable readings at 1.52 m and none at 1.85 m;
// a steel yardstick, 25 mm wide, was read at 2.15 m and lost at 2.45 m.
TEST(HcSr04, LosesSmallPlatesWhereTheRealOneDid) {
  EXPECT_TRUE(hears(panel(1.5, 0.033, 0.038)));
  EXPECT_FALSE(hears(panel(1.85, 0.033, 0.038)));
  EXPECT_TRUE(hears(panel(2.15, 0.0254, 0.86)));
  EXPECT_FALSE(hears(panel(2.45, 0.0254, 0.86)));
}

// Parallax PING))) guide: a cylinder of 3.5 inches is heard at 1.66 m and not at 2.29 m.
TEST(HcSr04, LosesACylinderWhereItsTwinDid) {
  PlainScene scene;
  scene.posts.push_back({{1.66 + 0.0445, 0.0}, 0.0445});
  EXPECT_TRUE(hears(scene));
  scene.posts[0].axis_W.x() = 2.29 + 0.0445;
  EXPECT_FALSE(hears(scene));
}

// Dyrkacz 2020, static envelope: a panel parallel to the sensor is heard while its edge is nearer
// to the axis than about 10 deg at 1.45 m and 4 deg at 2.45 m.
TEST(HcSr04, APanelBesideTheAxisMirrorsTheSoundAway) {
  const auto edge_deg = [](double distance_m) {
    double heard_deg = 0.0;
    for (double deg = 0.5; deg < 15.0; deg += 0.5) {
      const double edge_m = distance_m * std::tan(rad_from_deg(deg));
      if (hears(panel(distance_m, 0.61, 1.22, edge_m + 0.305))) heard_deg = deg;
    }
    return heard_deg;
  };
  const double near_deg = edge_deg(1.45), far_deg = edge_deg(2.45);
  EXPECT_NEAR(near_deg, 10.0, 2.0);
  // Fitted less well: the model's beam has no lobes.
  EXPECT_NEAR(far_deg, 4.0, 4.0);
  EXPECT_LT(far_deg, near_deg);
}

TEST(HcSr04, ASmoothWallIsLostAslantAndLeavesAreNot) {
  EXPECT_TRUE(hears(wall(1.5, 15.0, kSmooth)));
  EXPECT_FALSE(hears(wall(1.5, 40.0, kSmooth)));
  EXPECT_TRUE(hears(wall(1.5, 40.0, SurfaceClass::kCanopy)));
  EXPECT_TRUE(hears(wall(0.7, 60.0, SurfaceClass::kCanopy)));
  // The truth sees it all the same.
  const PlainScene scene = wall(1.5, 40.0, kSmooth);
  Bench bench(hc_sr04(), scene);
  EXPECT_TRUE(std::isinf(bench.step().range_m));
  EXPECT_NEAR(bench.truth().value().range_m, 1.5 / std::cos(rad_from_deg(25.0)), 1e-9);
}

TEST(HcSr04, AWeakFirstReturnIsPassedOver) {
  // A wire before a hedge: too slim to be heard at 1.5 m; the hedge is.
  PlainScene scene = wall(2.0, 0.0, SurfaceClass::kCanopy);
  scene.posts.push_back({{1.5, 0.0}, 0.002, SurfaceClass::kPost});
  Bench bench(hc_sr04(), scene);
  EXPECT_NEAR(bench.step().range_m, 2.0, 0.005);
  EXPECT_NEAR(bench.truth().value().range_m, 1.498, 1e-9);
}

TEST(Echo, StrengthsHaveTheirClosedForms) {
  EchoParams params;
  EXPECT_DOUBLE_EQ(beam_pattern(params, 0.0), 1.0);
  EXPECT_NEAR(beam_pattern(params, params.beam_half_power_rad), 0.5, 1e-12);
  // A Gaussian: its logarithm falls with the square of the angle.
  EXPECT_NEAR(beam_pattern(params, 2.0 * params.beam_half_power_rad), std::pow(0.5, 4), 1e-12);
  EXPECT_DOUBLE_EQ(echo_spreading(params, 1.0), 1.0);
  // Twice as far: a quarter, and 2 x 1 m x 1.3 dB/m less.
  EXPECT_NEAR(echo_spreading(params, 2.0), 0.25 * std::pow(10.0, -0.26), 1e-12);
  EXPECT_DOUBLE_EQ(surface_echo(params, kSmooth, 1.0), 1.0);
  EXPECT_NEAR(surface_echo(params, kSmooth, std::cos(params.smooth_lobe_rad)), std::exp(-1.0),
              1e-9);
  EXPECT_DOUBLE_EQ(surface_echo(params, SurfaceClass::kCanopy, 0.0), 0.1);
  EXPECT_DOUBLE_EQ(surface_echo(params, SurfaceClass::kTerrain, 0.5), 0.025);
}

TEST(Echo, ReturnsWithinAPulseAddUp) {
  EchoParams params;
  params.threshold = 1.0;
  params.pulse_m = 0.03;
  std::vector<EchoReturn> returns = {{2.0, 0.6}, {1.0, 0.6}, {1.5, 0.5}, {1.52, 0.4}, {2.02, 0.5}};
  EXPECT_EQ(first_echo_m(params, returns), 2.0);
  returns.push_back({1.53, 0.2});
  EXPECT_EQ(first_echo_m(params, returns), 1.5);
  params.threshold = 1.2;
  EXPECT_TRUE(std::isinf(first_echo_m(params, returns)));
  EXPECT_TRUE(std::isinf(first_echo_m(params, {})));
}

}  // namespace
}  // namespace vinerow::sensors::echo_test
