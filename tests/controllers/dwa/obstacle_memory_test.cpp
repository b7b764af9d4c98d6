// What ultrasonic echoes leave in the memory.

#include "controllers/dwa/obstacle_memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/controllers/dwa/course.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::obstacle_memory_test {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

/// A vehicle with one ranger at its nose (or two) and a memory; a tick is 0.1 s.
struct Bench {
  explicit Bench(controllers::ObstacleMemoryParams params = {},
                 const controllers::DistanceField& map = controllers::DistanceField(),
                 double half_angle_deg = 15.0, double height_m = 1.0, int sensors = 1)
      : known(map),
        half_angle_rad(rad_from_deg(half_angle_deg)),
        memory(params, mountings(sensors), known, make_four_wheel_rover().footprint_B, height_m) {}

  static std::vector<SensorMounting> mountings(int count) {
    std::vector<SensorMounting> result = make_rangers();
    result.resize(count);
    if (count == 1) result[0].X_BS.p = {0.95, 0.0, 0.0};
    return result;
  }
  void see(std::initializer_list<double> ranges_m, int times = 1) {
    for (int k = 0; k < times; ++k) {
      int i = 0;
      for (const double range_m : ranges_m) {
        RangeSample sample;
        sample.range_m = range_m;
        sample.max_range_m = 4.0;
        sample.half_angle_rad = half_angle_rad;
        sample.X_WS.p = {1e3, 1e3, 0.0};  // truth: must not be read
        memory.read(i++, sample);
      }
      now = now + Duration{100'000'000};
      memory.update(now, X_WB);
    }
  }
  std::size_t count() const { return memory.obstacles_W().size(); }

  controllers::DistanceField known;
  double half_angle_rad;
  controllers::ObstacleMemory memory;
  Pose X_WB;
  Time now;
};

TEST(ObstacleMemory, MarksTheArcAtTheEstimatedPose) {
  Bench bench;
  bench.X_WB = {quaternion_from_rpy({0, 0, 1.0}), {5, 7, 0}};
  bench.see({1.5}, 5);
  ASSERT_GE(bench.count(), 7u);  // 1.5 m * 30 deg = 0.79 m of arc, a point per 0.1 m
  const Eigen::Vector2d nose = Eigen::Vector2d(5, 7) + 0.95 * controllers::direction(1.0);
  double widest = 0.0;
  for (const Eigen::Vector2d& p : bench.memory.obstacles_W()) {
    EXPECT_NEAR((p - nose).norm(), 1.5, 1e-9);
    const double bearing = wrap_angle(std::atan2((p - nose).y(), (p - nose).x()) - 1.0);
    widest = std::max(widest, std::abs(bearing));
    EXPECT_LE(std::abs(bearing), rad_from_deg(15) + 1e-9);
  }
  EXPECT_NEAR(widest, rad_from_deg(15), 1e-9);
  // The point on the axis is at 1.5 m; with no width at all nothing else is ahead.
  EXPECT_NEAR(bench.memory.nearest_ahead_m({{5, 7}, 1.0}, 0.95, 0.05), 1.5, 1e-9);
}

TEST(ObstacleMemory, CountsOnlyConsistentEchoesAndRepeatedHits) {
  Bench bench;  // two in a row, then two hits: the third reading
  bench.see({1.5}, 2);
  EXPECT_EQ(bench.count(), 0u);
  bench.see({1.5});
  EXPECT_GT(bench.count(), 0u);
  Bench wild;
  for (int i = 0; i < 20; ++i) wild.see({i % 2 ? 1.0 : 2.0});
  EXPECT_EQ(wild.count(), 0u);
  Bench single;
  for (int i = 0; i < 20; ++i) single.see({i % 2 ? 1.0 : kNothing});
  EXPECT_EQ(single.count(), 0u);
}

TEST(ObstacleMemory, LeavesFarEchoesOut) {
  Bench bench;
  bench.see({2.51}, 10);
  EXPECT_EQ(bench.count(), 0u);
  bench.see({2.49}, 10);
  EXPECT_GT(bench.count(), 0u);
}

TEST(ObstacleMemory, LeavesOutWhatTheMapExplains) {
  // Canopies at y = +-0.95: an arc's end reaches within 0.25 m of them at r sin(15 deg) >= 0.7.
  const controllers::DistanceField alley(make_map(make_alley()).occupancy);
  Bench bench({.obstacle_range_m = 4.0}, alley);
  bench.X_WB.p = {10, 0, 0};
  bench.see({0.7 / std::sin(rad_from_deg(15)) + 0.05}, 10);
  EXPECT_EQ(bench.count(), 0u);
  bench.see({0.7 / std::sin(rad_from_deg(15)) - 0.15}, 10);
  EXPECT_GT(bench.count(), 0u);
}

TEST(ObstacleMemory, LeavesOutWhatTheGroundExplains) {
  // Height 0.5 m, cone 15 deg below the axis, ground rising by 5 deg: met at 0.5 / sin(20 deg).
  Bench bench({}, {}, 15.0, 0.5);
  const double ground_m = 0.5 / std::sin(rad_from_deg(20));
  bench.see({ground_m + 0.01}, 10);
  EXPECT_EQ(bench.count(), 0u);
  bench.see({ground_m - 0.01}, 10);
  EXPECT_GT(bench.count(), 0u);
  // A narrower cone sees the ground later.
  Bench narrow({}, {}, 7.5, 0.5);
  narrow.see({ground_m + 0.01}, 10);
  EXPECT_GT(narrow.count(), 0u);
}

TEST(ObstacleMemory, ForgetsWhatIsSeenThroughAndWhatIsOld) {
  Bench bench;
  bench.see({1.5}, 5);
  const std::size_t before = bench.count();
  bench.see({kNothing}, 2);
  EXPECT_EQ(bench.count(), before);
  bench.see({kNothing}, 1);
  EXPECT_LT(bench.count(), before);
  // The rim of the cone is not surely free; age takes the rest, but not from before the vehicle.
  bench.see({kNothing}, 400);
  EXPECT_GT(bench.count(), 0u);
  bench.X_WB.p.x() = 7.0;
  bench.see({kNothing});
  EXPECT_EQ(bench.count(), 0u);
  Bench young;
  young.see({1.5}, 5);
  young.X_WB.p.x() = 7.0;
  young.see({kNothing}, 290);
  EXPECT_GT(young.count(), 0u);
  young.see({kNothing}, 20);
  EXPECT_EQ(young.count(), 0u);
}

TEST(ObstacleMemory, ForgetsWhatTheVehicleStandsOn) {
  Bench bench;
  bench.see({0.4}, 5);
  EXPECT_GT(bench.count(), 0u);
  bench.X_WB.p.x() = 1.0;
  bench.memory.update(bench.now, bench.X_WB);
  EXPECT_EQ(bench.count(), 0u);
}

TEST(ObstacleMemory, OverlappingConesCarveTheTruePlace) {
  // Two rangers ahead, 0.3 m apart: only the left one sees something at 1.8 m, so it is on the
  // left.
  Bench bench({}, {}, 15.0, 1.0, 2);
  bench.see({1.8, kNothing}, 6);
  ASSERT_GT(bench.count(), 0u);
  for (const Eigen::Vector2d& p : bench.memory.obstacles_W()) {
    // The right cone's left rim, less what is not surely seen.
    const double bearing = std::atan2(p.y() + 0.15, p.x() - 0.95);
    EXPECT_GT(bearing, rad_from_deg(13.9));
    EXPECT_GT(p.y(), 0.25);
  }
}

TEST(ObstacleMemory, HoldsNoMoreThanItsCapacityAndTakesNoHeap) {
  Bench bench({.consistent_echoes = 1, .hits = 1});
  RandomStream random(1, "", "echoes");
  std::size_t allocations = 0;
  {
    AllocationCounter counter;
    for (int i = 0; i < 3000; ++i) {
      bench.X_WB.p = {random.uniform(0, 100), random.uniform(0, 100), 0};
      bench.see({random.uniform(0.5, 2.4)});
    }
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_LE(bench.count(), static_cast<std::size_t>(controllers::ObstacleMemory::kCapacity));
  EXPECT_GT(bench.count(), 200u);
}

}  // namespace
}  // namespace vinerow::test::obstacle_memory_test
