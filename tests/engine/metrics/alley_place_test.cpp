/// Place between the true rows, on a world of two alleys with values computed by hand.

#include "engine/metrics/alley_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "engine/api/map.h"
#include "engine/api/messages/path.h"
#include "engine/api/world_model.h"
#include "engine/physics/world_scene.h"
#include "tests/engine/physics/small_worlds.h"
#include "tests/support/no_alloc.h"

namespace vinerow::metrics::alley_place_test {
namespace {

using Eigen::Vector3d;
using Results = std::map<std::string, double>;

/// Ground that rises by 10 % to the east.
double ground_m(double x) {
  return 0.1 * x;
}

/// Rows along x from -8 to 8 m at y = 0, 2.5 and 5; the middle one runs from east to west. Canopy
/// of the first is 0.4 m wide, of the others 0.8 m: the first alley's walls are at 0.2 and 2.1 m,
/// its middle at 1.15 m; the second's at 2.9 and 4.6 m, its middle at 3.75 m.
constexpr double kMiddle0_m = 1.15, kMiddle1_m = 3.75;

class Bench {
 public:
  explicit Bench(bool flies) {
    if (flies) vehicle_.rotorcraft.emplace();
    world_.terrain =
        physics::test::make_terrain(61, 61, 0.5, [](double x, double) { return ground_m(x); });
    const auto line = [](double y, double from_x, double to_x) {
      return std::vector<Vector3d>{
          {from_x, y, ground_m(from_x)}, {0.0, y, 0.0}, {to_x, y, ground_m(to_x)}};
    };
    world_.rows->rows = {{0, line(0.0, -8, 8), 0.4, 0.5, 1.9},
                         {1, line(2.5, 8, -8), 0.8, 0.5, 2.0},
                         {2, line(5.0, -8, 8), 0.8, 0.5, 2.0}};
    // The last one has a row on one side only.
    world_.rows->alleys = {
        {0, line(1.25, -8, 8), 2.5}, {1, line(3.75, -8, 8), 2.5}, {2, line(6.25, -8, 8), 2.5}};
    scene_ = std::make_unique<physics::WorldScene>(world_);
    Ports out(bus_, "drone", "test");
    truth_ = out.write<Odometry>("truth");
    plan_ = out.write<PlannedPath>("plan");
    MetricContext context;
    context.part = "drone.metrics.alley_place";
    context.vehicle_description = &vehicle_;
    context.scene = scene_.get();
    context.world = &world_;
    metric_ = make_alley_place({}, context);
    Ports ports(bus_, "drone", context.part);
    metric_->connect(ports);
  }

  void at(double x, double y, double height_m = 1.5) {
    now_ = now_ + Duration{50'000'000};
    Odometry truth;
    truth.X_WB.p = {x, y, ground_m(x) + height_m};
    truth_.write(now_, truth);
    metric_->step(now_);
  }
  /// From x to x at a place across, a look every 20 cm.
  void along(double from_x, double to_x, double y, double height_m = 1.5) {
    const int looks = static_cast<int>(std::ceil(std::abs(to_x - from_x) / 0.2));
    for (int k = 0; k <= looks; ++k) at(from_x + (to_x - from_x) * k / looks, y, height_m);
  }
  void plan(const PlannedPath& path) { plan_.write(now_, path); }
  double result(const std::string& name) const { return metric_->results().at(name); }
  Results results() const { return metric_->results(); }

 private:
  WorldModel world_;
  std::unique_ptr<physics::WorldScene> scene_;
  VehicleDescription vehicle_;
  SignalBus bus_;
  Time now_;
  std::unique_ptr<Metric> metric_;
  SignalWriter<Odometry> truth_;
  SignalWriter<PlannedPath> plan_;
};

TEST(AlleyPlace, IsTheDistanceFromTheMiddleBetweenTheWalls) {
  Bench bench(false);
  bench.at(1.0, kMiddle0_m);
  EXPECT_NEAR(bench.result("alley_offset_max_m"), 0.0, 1e-12);
  bench.at(2.0, kMiddle0_m + 0.3);
  bench.at(3.0, kMiddle0_m - 0.1);
  EXPECT_NEAR(bench.result("alley_offset_mean_m"), (0.0 + 0.3 - 0.1) / 3, 1e-12);
  EXPECT_NEAR(bench.result("alley_offset_rms_m"), std::sqrt((0.09 + 0.01) / 3), 1e-12);
  EXPECT_NEAR(bench.result("alley_offset_max_m"), 0.3, 1e-12);
}

TEST(AlleyPlace, AShiftedMapShowsAsAMeanWhicheverWayTheAlleysAreDriven) {
  Bench bench(false);
  bench.along(-9, 9, kMiddle0_m + 0.25);
  bench.along(9, -9, kMiddle1_m + 0.25);
  EXPECT_NEAR(bench.result("alley_offset_mean_m"), 0.25, 1e-12);
  EXPECT_NEAR(bench.result("alley_offset_rms_m"), 0.25, 1e-12);
  EXPECT_EQ(bench.result("alleys_passed"), 2.0);
}

TEST(AlleyPlace, OutsideTheAlleysNothingIsMeasured) {
  Bench bench(true);
  bench.at(-8.5, kMiddle0_m);      // before the rows
  bench.at(8.5, kMiddle0_m);       // beyond them
  bench.at(0.0, -1.0);             // beside the first row
  bench.at(0.0, 6.25);             // beside the last one
  bench.at(0.0, kMiddle0_m, 2.1);  // above the canopy
  for (const auto& [name, value] : bench.results()) {
    if (name == "alleys_passed") {
      EXPECT_EQ(value, 0.0);
    } else {
      EXPECT_TRUE(std::isnan(value)) << name;
    }
  }
}

TEST(AlleyPlace, HeightIsAboveTheTrueGroundAndOnlyOfWhatFlies) {
  Bench bench(true);
  bench.at(-5.0, kMiddle0_m, 1.4);
  bench.at(5.0, kMiddle0_m, 1.6);
  EXPECT_NEAR(bench.result("alley_height_min_m"), 1.4, 1e-6);
  EXPECT_NEAR(bench.result("alley_height_max_m"), 1.6, 1e-6);
  Bench driven(false);
  EXPECT_EQ(driven.results().count("alley_height_min_m"), 0u);
}

TEST(AlleyPlace, AnAlleyIsPassedFromEndToEnd) {
  Bench bench(false);
  bench.along(-9, 6.0, kMiddle0_m);  // 14 of 16 m
  bench.along(6.0, -9.0, kMiddle0_m);
  EXPECT_EQ(bench.result("alleys_passed"), 0.0);
  bench.along(9, 5.0, kMiddle0_m);  // the rest from the other side
  EXPECT_EQ(bench.result("alleys_passed"), 1.0);
}

TEST(AlleyPlace, OfAPlanTheLegsCount) {
  Bench bench(true);
  bench.at(0.0, kMiddle1_m, 1.0);
  EXPECT_NEAR(bench.result("alley_height_min_m"), 1.0, 1e-6) << "no plan: everywhere";
  PlannedPath path;
  const auto add = [&](double x, double z, PathKind kind) {
    PathPoint point;
    point.p_W = {x, kMiddle0_m, ground_m(x) + z};
    point.kind = kind;
    path.points.push_back(point);
  };
  add(-6, 0.2, PathKind::kVertical);
  add(-6, 1.5, PathKind::kLeg);
  add(6, 1.5, PathKind::kVertical);
  add(6, 0.2, PathKind::kVertical);
  Bench planned(true);
  planned.plan(path);
  planned.at(-6.0, kMiddle0_m, 0.3);  // taking off in the alley
  planned.at(0.0, kMiddle0_m + 0.1, 1.45);
  planned.at(6.0, kMiddle0_m, 0.4);  // landing in it
  EXPECT_NEAR(planned.result("alley_height_min_m"), 1.45, 1e-6);
  EXPECT_NEAR(planned.result("alley_offset_rms_m"), 0.1, 1e-12);
}

TEST(AlleyPlace, NamesItsResultsAndAllocatesNothing) {
  Bench bench(true);
  const Results results = bench.results();
  EXPECT_EQ(results.size(), alley_place_results().size());
  for (const ResultSpec& number : alley_place_results()) {
    EXPECT_EQ(results.count(number.name), 1u);
  }
  bench.at(-9.0, kMiddle0_m);
  const test::AllocationCounter counter;
  bench.along(-8.5, 8.5, kMiddle0_m);
  EXPECT_EQ(counter.count(), 0u);
}

}  // namespace
}  // namespace vinerow::metrics::alley_place_test
