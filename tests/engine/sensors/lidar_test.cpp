#include "engine/sensors/lidar.h"
#include "engine/api/messages/sensors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"
#include "tests/engine/sensors/ranging_bench.h"
#include "tests/support/no_alloc.h"
#include "tests/support/plain_scene.h"

namespace vinerow::sensors::lidar_test {
namespace {

using test::PlainScene;
using test::SensorValues;
using Bench = test::RangingBench<LaserScan>;

double angle_of(const LaserScan& scan, std::size_t beam) {
  return scan.first_angle_rad + static_cast<double>(beam) * scan.angle_step_rad;
}

PlainScene wall_ahead(double distance_m, SurfaceClass surface = SurfaceClass::kObstacle) {
  PlainScene scene;
  scene.panels.push_back({{distance_m, 0, 0}, {-1, 0, 0}, surface});
  return scene;
}

TEST(Lidar, BeamsRunFromRightToLeftOverTheFieldOfView) {
  const PlainScene scene;
  Bench bench("lidar", {}, scene, 40.0);
  const LaserScan& scan = bench.step();
  ASSERT_EQ(scan.ranges_m.size(), 1081u);  // as the data sheet of the UST-10LX has it
  EXPECT_NEAR(scan.first_angle_rad, -rad_from_deg(135.0), 1e-12);
  EXPECT_NEAR(angle_of(scan, 1080), rad_from_deg(135.0), 1e-9);
  for (const double range_m : scan.ranges_m) EXPECT_TRUE(std::isinf(range_m));
  Bench tim(test::data_sheet("sick_tim571"), scene);
  EXPECT_EQ(tim.step().ranges_m.size(), 811u);  // 270 deg by thirds of a degree
}

TEST(Lidar, ACornerIsReadExactly) {
  // Walls x = 3 and y = 2 (left): closed form min(3 / cos a, 2 / sin a).
  PlainScene scene = wall_ahead(3.0);
  scene.panels.push_back({{0, 2, 0}, {0, -1, 0}, SurfaceClass::kObstacle});
  Bench bench("lidar", {{"noise_std_m", 0.0}, {"max_range_m", 8.0}}, scene, 40.0);
  const LaserScan& scan = bench.step();
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double a = angle_of(scan, i);
    double expected = std::numeric_limits<double>::infinity();
    if (std::cos(a) > 0.0) expected = std::min(expected, 3.0 / std::cos(a));
    if (std::sin(a) > 0.0) expected = std::min(expected, 2.0 / std::sin(a));
    if (expected > 8.0) {
      EXPECT_TRUE(std::isinf(scan.ranges_m[i])) << i;
    } else {
      EXPECT_NEAR(scan.ranges_m[i], expected, 1e-9) << i;
    }
    EXPECT_EQ(scan.ranges_m[i], bench.truth().value().ranges_m[i]);
  }
}

TEST(Lidar, PitchedDownItSeesTheGroundInAStraightLine) {
  const PlainScene ground{test::GroundPlane{}};
  Bench bench("lidar", {{"noise_std_m", 0.0}, {"rotation_deg", std::vector<double>{0, 20, 0}}},
              ground, 40.0);
  Pose high;
  high.p.z() = 0.5;
  bench.place(high);
  const LaserScan& scan = bench.step();
  int seen = 0;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    if (std::isinf(scan.ranges_m[i])) continue;
    ++seen;
    // The scan's plane meets the ground at x = 0.5 m / tan 20 deg.
    const double a = angle_of(scan, i);
    const Eigen::Vector3d p = scan.X_WS * Eigen::Vector3d(scan.ranges_m[i] * std::cos(a),
                                                          scan.ranges_m[i] * std::sin(a), 0.0);
    EXPECT_NEAR(p.x(), 0.5 / std::tan(rad_from_deg(20.0)), 1e-9);
    EXPECT_NEAR(p.z(), 0.0, 1e-9);
  }
  EXPECT_GT(seen, 300);
}

TEST(Lidar, NoiseGrowsWithDistance) {
  for (const double distance_m : {1.0, 9.0}) {
    const PlainScene scene = wall_ahead(distance_m);
    Bench bench("lidar",
                {{"field_of_view_deg", 0.0}, {"noise_std_m", 0.01}, {"noise_growth", 0.002}}, scene,
                40.0);
    constexpr int kCount = 20'000;
    double squares = 0.0, sum = 0.0;
    for (int i = 0; i < kCount; ++i) {
      const double error = bench.step().ranges_m.at(0) - distance_m;
      sum += error;
      squares += error * error;
    }
    const double expected = 0.01 + 0.002 * distance_m;
    EXPECT_NEAR(std::sqrt(squares / kCount), expected, 5.0 * expected / std::sqrt(2.0 * kCount));
    EXPECT_NEAR(sum / kCount, 0.0, 5.0 * expected / std::sqrt(kCount));
  }
}

TEST(Lidar, TheConstantErrorIsTheDevicesOwn) {
  const PlainScene scene = wall_ahead(5.0);
  const SensorValues values = {
      {"field_of_view_deg", 0.0}, {"noise_std_m", 0.0}, {"accuracy_m", 0.04}};
  double smallest = 1.0, largest = -1.0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Bench bench("lidar", values, scene, 40.0, seed);
    const double error = bench.step().ranges_m.at(0) - 5.0;
    EXPECT_EQ(bench.step().ranges_m.at(0) - 5.0, error);
    EXPECT_LE(std::abs(error), 0.04);
    smallest = std::min(smallest, error), largest = std::max(largest, error);
  }
  // Fifty uniform numbers leave no tenth of their range free at either end but in 1 % of cases.
  EXPECT_LT(smallest, -0.032);
  EXPECT_GT(largest, 0.032);
}

/// Share of beams that are detected on a wall, 20,000 of them.
double detected(double distance_m, double reflectance, double aslant_deg = 0.0) {
  const double a = rad_from_deg(aslant_deg);
  PlainScene scene;
  scene.panels.push_back({{distance_m, 0, 0}, {-std::cos(a), std::sin(a), 0}, SurfaceClass::kPost});
  Bench bench("lidar",
              {{"field_of_view_deg", 0.0},
               {"max_range_m", 30.0},
               {"dark_range_m", 4.0},
               {"stem_reflectance", reflectance}},
              scene, 40.0);
  int count = 0;
  for (int i = 0; i < 20'000; ++i) count += std::isfinite(bench.step().ranges_m.at(0));
  return count / 20'000.0;
}

TEST(Lidar, BeamsAreLostByDistanceReflectanceAndIncidence) {
  constexpr double kSlack = 5.0 * 0.5 / 141.4;  // five standard errors at most
  // The data sheet's dark target at its stated range, and white (0.9) at three times of that.
  EXPECT_NEAR(detected(4.0, 0.1), 0.9, kSlack);
  EXPECT_NEAR(detected(12.0, 0.9), 0.9, kSlack);
  // Twice as far, a quarter of the power: (1/4)^4 / ((1/4)^4 + 1/9).
  EXPECT_NEAR(detected(8.0, 0.1), 0.0340, kSlack);
  // 60 deg aslant, half of the power.
  EXPECT_NEAR(detected(4.0, 0.1, 60.0), 0.36, kSlack);
  EXPECT_GT(detected(1.0, 0.1), 0.9999);
}

TEST(Lidar, AWideBeamAtAnEdgeReadsTheNearerOrAMixture) {
  // A post's edge covers the left of three sub-rays at 2 m, a wall 0.4 m behind it the others.
  PlainScene scene = wall_ahead(2.4, SurfaceClass::kPost);
  scene.panels.push_back({{2.0, 0.51, 0}, {-1, 0, 0}, SurfaceClass::kPost, 0.5, 1.0});
  const double width_deg = 2.0 * deg_from_rad(std::atan(0.02 / 2.0));
  SensorValues values = {{"field_of_view_deg", 0.0},
                         {"noise_std_m", 0.0},
                         {"divergence_deg", width_deg},
                         {"sub_rays", std::int64_t{3}}};
  Bench nearest("lidar", values, scene, 40.0);
  const double side_m = std::hypot(2.0, 0.02);
  EXPECT_NEAR(nearest.step().ranges_m.at(0), side_m, 1e-9);
  // The truth is the beam's middle.
  EXPECT_NEAR(nearest.truth().value().ranges_m.at(0), 2.4, 1e-9);
  values.emplace_back("edge", std::string("mixed"));
  Bench mixed("lidar", values, scene, 40.0);
  // Weights cos / r^2: of the side rays 2 / side^3 and 2.4 / far^3, of the middle 1 / 2.4^2.
  const double far_m = side_m * 1.2;
  const double w_side = 2.0 / std::pow(side_m, 3), w_far = 2.4 / std::pow(far_m, 3),
               w_mid = 1.0 / (2.4 * 2.4);
  const double expected =
      (w_side * side_m + w_far * far_m + w_mid * 2.4) / (w_side + w_far + w_mid);
  EXPECT_NEAR(mixed.step().ranges_m.at(0), expected, 1e-9);
  // Farther apart than the pulse is long, the first echo stands alone.
  values.emplace_back("pulse_m", 0.3);
  Bench apart("lidar", values, scene, 40.0);
  EXPECT_NEAR(apart.step().ranges_m.at(0), side_m, 1e-9);
}

TEST(Lidar, WhatIsSeenShiftsNoRandomNumber) {
  PlainScene first = wall_ahead(2.0), second;
  const SensorValues values = {{"field_of_view_deg", 10.0}, {"beam_dropout_share", 0.1}};
  Bench a("lidar", values, first, 40.0), b("lidar", values, second, 40.0);
  for (int i = 0; i < 51; ++i) a.step_only(), b.step_only();
  second = first;
  for (int i = 0; i < 20; ++i) ASSERT_EQ(a.step().ranges_m, b.step().ranges_m);
  Bench other("lidar", values, first, 40.0, 2);
  EXPECT_NE(other.step().ranges_m, a.step().ranges_m);
}

TEST(Lidar, AStepAllocatesNothingWithADelayToo) {
  const PlainScene scene = wall_ahead(2.0);
  Bench bench(test::data_sheet("hokuyo_ust10lx", {{"delay_s", 0.05}}), scene);
  bench.step_only();
  bench.step_only();
  bench.sensor().deliver(bench.now());
  const test::AllocationCounter counter;
  for (int i = 0; i < 5; ++i) {
    bench.step_only();
    bench.sensor().deliver(bench.now());
  }
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_EQ(bench.reading().sequence(), 6u);
  EXPECT_EQ(bench.reading().stamp().ns, 5 * 25'000'000);
}

TEST(Lidar, AnOutageIsAScanWithoutAnEcho) {
  const PlainScene scene = wall_ahead(2.0);
  const ParameterSet parameters =
      test::with_outage(test::sensor_parameters("lidar", {{"field_of_view_deg", 2.0}}), 0.0, 0.025);
  Bench bench("lidar", parameters, scene, 40.0, 1);
  for (const double range_m : bench.step().ranges_m) EXPECT_TRUE(std::isinf(range_m));
  EXPECT_EQ(bench.truth().value().ranges_m[4], 2.0);
  for (const double range_m : bench.step().ranges_m) EXPECT_NEAR(range_m, 2.0, 0.06);
}

TEST(Lidar, RefusesBadInputInOneSentence) {
  const PlainScene scene;
  const auto error_of = [&](const SensorValues& values) {
    return test::refusal_of([&] { Bench bench("lidar", values, scene, 40.0); });
  };
  EXPECT_EQ(error_of({{"angle_step_deg", 0.01}}),
            "angle_step_deg = 0.01 deg makes 27001 beams of field_of_view_deg = 270 deg, must be "
            "at most 20000");
  EXPECT_EQ(error_of({{"sub_rays", std::int64_t{4}}}),
            "sub_rays = 4, must be odd: one ray is in the middle");
  EXPECT_EQ(error_of({{"min_range_m", 12.0}}), "min_range_m = 12 m, must be < max_range_m = 10 m");
}

}  // namespace
}  // namespace vinerow::sensors::lidar_test
