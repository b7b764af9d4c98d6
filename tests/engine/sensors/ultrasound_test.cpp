#include "engine/sensors/ultrasound.h"
#include "engine/api/messages/sensors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"
#include "engine/sensors/sound_cone.h"
#include "tests/engine/sensors/ranging_bench.h"
#include "tests/support/no_alloc.h"
#include "tests/support/plain_scene.h"

namespace vinerow::sensors::ultrasound_test {
namespace {

using test::Panel;
using test::PlainScene;
using Bench = test::RangingBench<RangeSample>;

constexpr double kNothing_m = std::numeric_limits<double>::infinity();

/// A wall whose nearest point is `distance_m` away, `aslant_deg` left of x.
PlainScene wall(double distance_m, double aslant_deg = 0.0,
                SurfaceClass surface = SurfaceClass::kCanopy) {
  const double a = rad_from_deg(aslant_deg);
  const Eigen::Vector3d direction(std::cos(a), std::sin(a), 0.0);
  PlainScene scene;
  scene.panels.push_back({distance_m * direction, -direction, surface});
  return scene;
}

TEST(SoundCone, SharesOfTheRaysAreTheirSolidAngles) {
  const double half_angle = rad_from_deg(15.0);
  const std::vector<ConeRay> rays = cone_rays(half_angle, 6);
  ASSERT_EQ(rays.size(), 1u + 3 * 6 * 7);
  double sum = 0.0, mean_x = 0.0;
  for (const ConeRay& ray : rays) {
    EXPECT_NEAR(ray.dir_S.norm(), 1.0, 1e-12);
    EXPECT_NEAR(ray.dir_S.x(), std::cos(ray.off_axis_rad), 1e-12);
    EXPECT_LE(ray.off_axis_rad, half_angle + 1e-12);
    sum += ray.share;
    mean_x += ray.share * ray.dir_S.x();
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  // Mean of x over a cap. The rim's rays stand for half a ring inside them: (1 - cos 15) / 24.
  EXPECT_NEAR(mean_x, 0.5 * (1.0 + std::cos(half_angle)), 0.0015);
}

TEST(Ultrasound, TheFirstReturnOfAWallAslantIsAtTheConesRim) {
  // Closed form: the rim's ray meets a wall at distance d, aslant by a, after d / cos(a - 15 deg).
  for (const double aslant_deg : {20.0, 35.0, 50.0, 65.0}) {
    const PlainScene scene = wall(1.2, aslant_deg);
    Bench bench("ultrasound", {{"noise_std_m", 0.0}}, scene);
    EXPECT_NEAR(bench.step().range_m, 1.2 / std::cos(rad_from_deg(aslant_deg - 15.0)), 1e-9);
    EXPECT_EQ(bench.truth().value().range_m, bench.reading().value().range_m);
  }
  // Inside the cone the foot of the perpendicular is the first return; rings of rays 7.5 deg apart
  // miss it by half of that at most, along the ring and across.
  for (const double aslant_deg : {0.0, 4.0, 8.0, 12.0}) {
    const PlainScene scene = wall(1.2, aslant_deg);
    Bench bench("ultrasound", {{"noise_std_m", 0.0}}, scene);
    EXPECT_GE(bench.step().range_m, 1.2 - 1e-12);
    EXPECT_LE(bench.step().range_m, 1.2 / std::cos(rad_from_deg(5.4)));
  }
}

TEST(Ultrasound, ARoundPostReturnsFromItsFront) {
  PlainScene scene;
  scene.posts.push_back({{1.0, 0.0}, 0.03});
  Bench ahead("ultrasound", {{"noise_std_m", 0.0}}, scene);
  EXPECT_NEAR(ahead.step().range_m, 0.97, 1e-12);
  // Beside the axis the front is not met exactly: rays 1 deg apart pass within 0.5 deg of it, which
  // is 9 mm beside the axis of a post of 30 mm: 30 - sqrt(30^2 - 9^2) = 1.4 mm behind its front.
  for (const double aside_deg : {3.0, 7.0, 11.0, 14.0}) {
    const double a = rad_from_deg(aside_deg);
    scene.posts[0].axis_W = {std::cos(a), std::sin(a)};
    Bench off_axis("ultrasound", {{"noise_std_m", 0.0}, {"rings", std::int64_t{15}}}, scene);
    EXPECT_GE(off_axis.step().range_m, 0.97);
    EXPECT_LE(off_axis.step().range_m, 0.9714) << aside_deg;
  }
}

TEST(Ultrasound, UniformNoiseFillsItsAccuracyAndNoMore) {
  const PlainScene scene = wall(1.2);
  Bench bench("ultrasound", {{"error", std::string("uniform")}, {"accuracy_m", 0.003}}, scene);
  constexpr int kCount = 20'000;
  double sum = 0.0, squares = 0.0, largest = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double error = bench.step().range_m - 1.2;
    ASSERT_LE(std::abs(error), 0.003 + 1e-12);
    sum += error;
    squares += error * error;
    largest = std::max(largest, std::abs(error));
    ASSERT_EQ(bench.truth().value().range_m, 1.2);
  }
  EXPECT_GT(largest, 0.00299);
  // Moments of a uniform variable; five standard errors.
  EXPECT_NEAR(sum / kCount, 0.0, 5.0 * 0.003 / std::sqrt(3.0 * kCount));
  EXPECT_NEAR(squares / kCount, 3e-6, 5.0 * std::sqrt(4.0 / 45.0 / kCount) * 9e-6);
}

TEST(Ultrasound, GaussianNoiseHasItsStandardDeviation) {
  const PlainScene scene = wall(1.2);
  Bench bench("ultrasound", {{"noise_std_m", 0.01}}, scene);
  constexpr int kCount = 20'000;
  double squares = 0.0;
  for (int i = 0; i < kCount; ++i) squares += std::pow(bench.step().range_m - 1.2, 2);
  EXPECT_NEAR(std::sqrt(squares / kCount), 0.01, 5.0 * 0.01 / std::sqrt(2.0 * kCount));
}

TEST(Ultrasound, ReadingsAreMultiplesOfTheResolution) {
  const PlainScene scene = wall(1.2345);
  Bench bench("ultrasound", {{"noise_std_m", 0.0}, {"resolution_m", 0.01}}, scene);
  EXPECT_DOUBLE_EQ(bench.step().range_m, 1.23);
  EXPECT_DOUBLE_EQ(bench.truth().value().range_m, 1.2345);
}

TEST(Ultrasound, AColdSensorsSpeedOfSoundScalesTheRange) {
  // Speed of sound 331.3 m/s at 0 degC and 349.0 m/s at 30 degC (tables): in warm air the echo
  // comes early.
  const PlainScene scene = wall(3.0);
  Bench bench(
      "ultrasound",
      {{"noise_std_m", 0.0}, {"air_temperature_degC", 30.0}, {"assumed_temperature_degC", 0.0}},
      scene);
  EXPECT_NEAR(bench.step().range_m, 3.0 * 331.3 / 349.0, 3.0 * 0.0002);
}

TEST(Ultrasound, NearAndFarAreCutOff) {
  const SceneQuery& nobody = PlainScene{};
  Bench far("ultrasound", {{"noise_std_m", 0.0}}, nobody);
  EXPECT_EQ(far.step().range_m, kNothing_m);
  EXPECT_EQ(far.truth().value().range_m, kNothing_m);
  const PlainScene touching = wall(0.005);
  Bench near("ultrasound", {{"noise_std_m", 0.0}}, touching);
  EXPECT_EQ(near.step().range_m, 0.02);
  EXPECT_NEAR(near.truth().value().range_m, 0.005, 1e-12);
  // In range, but in cold air the echo comes late, as from 3.9 m x 349.0 / 331.3 = 4.1 m.
  const PlainScene in_range = wall(3.9);
  Bench cold(
      "ultrasound",
      {{"noise_std_m", 0.0}, {"air_temperature_degC", 0.0}, {"assumed_temperature_degC", 30.0}},
      in_range);
  EXPECT_EQ(cold.step().range_m, kNothing_m);
  EXPECT_NEAR(cold.truth().value().range_m, 3.9, 1e-12);
}

TEST(Ultrasound, MissedAndFalseEchoesHaveTheirShares) {
  const PlainScene scene = wall(2.0);
  Bench bench("ultrasound", {{"noise_std_m", 0.0}, {"missed_share", 0.3}, {"false_share", 0.2}},
              scene);
  constexpr int kCount = 20'000;
  int missed = 0, wrong = 0;
  double sum = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double range_m = bench.step().range_m;
    ASSERT_EQ(bench.truth().value().range_m, 2.0);
    missed += std::isinf(range_m);
    if (std::isinf(range_m) || range_m == 2.0) continue;
    ++wrong;
    ASSERT_GE(range_m, 0.02);
    ASSERT_LT(range_m, 2.0);
    sum += range_m;
  }
  // Binomial, five standard deviations; a false echo comes before a missing one is noticed.
  EXPECT_NEAR(wrong, 0.2 * kCount, 5.0 * std::sqrt(0.2 * 0.8 * kCount));
  EXPECT_NEAR(missed, 0.24 * kCount, 5.0 * std::sqrt(0.24 * 0.76 * kCount));
  // Uniform between 0.02 m and 2 m.
  EXPECT_NEAR(sum / wrong, 1.01, 5.0 * 1.98 / std::sqrt(12.0 * wrong));
}

TEST(Ultrasound, FalseEchoesComeWithNothingThereToo) {
  const PlainScene nobody;
  Bench bench("ultrasound", {{"false_share", 1.0}}, nobody);
  double sum = 0.0;
  for (int i = 0; i < 10'000; ++i) sum += bench.step().range_m;
  EXPECT_NEAR(sum / 10'000, 2.01, 5.0 * 3.98 / std::sqrt(12.0 * 10'000));
}

TEST(Ultrasound, WhatIsSeenShiftsNoRandomNumber) {
  PlainScene first = wall(1.0), second;  // the second's wall comes later
  const test::SensorValues values = {
      {"missed_share", 0.2}, {"false_share", 0.1}, {"echo_threshold", 0.001}};
  Bench a("ultrasound", values, first), b("ultrasound", values, second);
  for (int i = 0; i < 101; ++i) a.step_only(), b.step_only();
  second = first;
  for (int i = 0; i < 200; ++i) ASSERT_EQ(a.step().range_m, b.step().range_m) << i;
}

TEST(Ultrasound, FourRangersFireInTurn) {
  const PlainScene scene = wall(1.0);
  for (int k = 0; k < 4; ++k) {
    Bench bench("ultrasound", {{"cycle_s", 0.2}, {"phase_s", 0.05 * k}, {"delay_s", 0.05}}, scene);
    int heard = 0;
    for (int i = 0; i < 40; ++i) {
      const std::uint64_t before = bench.truth().sequence();
      bench.step_only();
      const bool fires = i % 4 == k;
      EXPECT_EQ(bench.truth().sequence() - before, fires ? 1u : 0u);
      const std::uint64_t delivered = bench.reading().sequence();
      bench.sensor().deliver(bench.now());
      EXPECT_EQ(bench.reading().sequence() - delivered, fires ? 1u : 0u);
      heard += fires;
    }
    EXPECT_EQ(heard, 10);
    // The last pulse was at 1.8 s + phase.
    EXPECT_EQ(bench.reading().stamp().ns, 1'800'000'000 + k * 50'000'000);
  }
}

TEST(Ultrasound, TurnsCountFromTheFirstTick) {
  // A vehicle whose phase of a mission begins 2.5 ms beside the multiples of the sensor's period.
  const PlainScene scene = wall(1.0);
  for (int k = 0; k < 4; ++k) {
    Bench bench("ultrasound", {{"cycle_s", 0.2}, {"phase_s", 0.05 * k}}, scene);
    bench.start_at(Time{296'452'500'000});
    for (int i = 0; i < 40; ++i) {
      const std::uint64_t before = bench.truth().sequence();
      bench.step_only();
      EXPECT_EQ(bench.truth().sequence() - before, i % 4 == k ? 1u : 0u);
    }
  }
}

TEST(Ultrasound, OutagesAndDropoutsLeaveTheTruth) {
  const PlainScene scene = wall(1.0);
  const ParameterSet parameters = test::with_outage(
      test::sensor_parameters("ultrasound", {{"dropout_share", 0.25}, {"noise_std_m", 0.0}}), 1.0,
      2.0);
  Bench bench("ultrasound", parameters, scene, 20.0, 1);
  constexpr int kCount = 4000;
  for (int i = 0; i < kCount; ++i) {
    const std::uint64_t before = bench.reading().sequence();
    bench.step_only();
    if (bench.reading().sequence() != before) {
      EXPECT_EQ(std::isinf(bench.reading().value().range_m), i >= 20 && i < 40) << i;
    }
    EXPECT_EQ(bench.truth().value().range_m, 1.0);
  }
  EXPECT_EQ(bench.truth().sequence(), static_cast<std::uint64_t>(kCount));
  EXPECT_NEAR(static_cast<double>(bench.reading().sequence()), 0.75 * kCount,
              5.0 * std::sqrt(0.25 * 0.75 * kCount));
}

TEST(Ultrasound, ListeningAllocatesNothing) {
  const PlainScene scene = wall(1.0, 10.0);
  Bench bench(test::data_sheet("hc_sr04"), scene);
  bench.step();
  const test::AllocationCounter counter;
  for (int i = 0; i < 50; ++i) bench.step();
  EXPECT_EQ(counter.count(), 0u);
}

TEST(Ultrasound, RefusesBadInputInOneSentence) {
  const PlainScene scene;
  const auto error_of = [&](const test::SensorValues& values) {
    return test::refusal_of([&] { Bench bench("ultrasound", values, scene); });
  };
  EXPECT_EQ(
      error_of({{"cycle_s", 0.12}}),
      "rover.sensors.s: cycle_s = 0.12 s, must be a multiple of the sensor's period of 0.05 s");
  EXPECT_EQ(
      error_of({{"cycle_s", 0.2}, {"phase_s", 0.03}}),
      "rover.sensors.s: phase_s = 0.03 s, must be a multiple of the sensor's period of 0.05 s");
  EXPECT_EQ(error_of({{"cycle_s", 0.2}, {"phase_s", 0.2}}),
            "rover.sensors.s: phase_s = 0.2 s, must be < cycle_s = 0.2 s");
  EXPECT_EQ(error_of({{"phase_s", 0.05}}),
            "rover.sensors.s: phase_s = 0.05 s, must be < cycle_s = 0 s");
  EXPECT_EQ(error_of({{"min_range_m", 5.0}}), "min_range_m = 5 m, must be < max_range_m = 4 m");
}

}  // namespace
}  // namespace vinerow::sensors::ultrasound_test
