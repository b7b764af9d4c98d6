/// Clearance and touches of a box beside boxes, with values computed by hand.

#include "engine/metrics/clearance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "engine/physics/world_scene.h"
#include "tests/engine/physics/small_worlds.h"

namespace vinerow::metrics::clearance_test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using physics::test::make_box_mesh;
using physics::test::make_instance;
using ::testing::HasSubstr;

/// A hull of 1.0 x 0.8 x 0.6 m whose centre is 0.1 m ahead of B and 0.2 m above it.
constexpr double kHalfLength_m = 0.5, kHalfWidth_m = 0.4, kHalfHeight_m = 0.3;
constexpr double kAhead_m = 0.1, kUp_m = 0.2;

class Bench {
 public:
  explicit Bench(std::vector<MeshInstance> meshes, double search_radius_m = 3.0) {
    world_.terrain = physics::test::make_flat();
    world_.meshes = std::move(meshes);
    scene_ = std::make_unique<physics::WorldScene>(world_);
    vehicle_.collision_half_extents_m = {kHalfLength_m, kHalfWidth_m, kHalfHeight_m};
    vehicle_.collision_centre_B = {kAhead_m, 0, kUp_m};
    Ports out(bus_, "rover", "test");
    truth_ = out.write<Odometry>("truth");
    contacts_ = out.write<NamedValues>("contacts");
    ParameterSet parameters(clearance_spec().parameters, "clearance");
    parameters.set("search_radius_m", search_radius_m);
    MetricContext context;
    context.part = "rover.metrics.clearance";
    context.vehicle_description = &vehicle_;
    context.scene = scene_.get();
    metric_ = make_clearance(parameters, context);
    Ports ports(bus_, "rover", context.part);
    metric_->connect(ports);
    event_ = Ports(bus_, "run", "test").read<Event>("rover/clearance_event");
  }

  void at(double t_s, const Vector3d& p_W, double yaw_rad = 0.0) {
    const Time now = Time{} + duration_from_s(t_s);
    Odometry truth;
    truth.X_WB = {quaternion_from_rpy({0, 0, yaw_rad}), p_W};
    truth_.write(now, truth);
    metric_->step(now);
  }
  void rigid_touches(double count) {
    contacts_.write(Time{}, {{"touches", "touching"}, {count, 0.0}});
  }
  double result(const std::string& name) const { return metric_->results().at(name); }
  const SignalReader<Event>& event() const { return event_; }

 private:
  WorldModel world_;
  std::unique_ptr<physics::WorldScene> scene_;
  VehicleDescription vehicle_;
  SignalBus bus_;
  std::unique_ptr<Metric> metric_;
  SignalWriter<Odometry> truth_;
  SignalWriter<NamedValues> contacts_;
  SignalReader<Event> event_;
};

/// A hedge along x whose near side is at y = 1.5 m, from 0.5 to 1.5 m above ground.
MeshInstance hedge() {
  return make_instance("hedge", make_box_mesh({8.0f, 0.25f, 0.5f}), {0, 1.75, 1.0},
                       SurfaceClass::kCanopy);
}

TEST(Clearance, IsTheGapBetweenHullAndLeaves) {
  Bench bench({hedge()});
  bench.at(0.0, {0, 0, 0.8});
  // 1.5 m to the leaves less half the hull's width.
  EXPECT_NEAR(bench.result("min_clearance_m"), 1.5 - kHalfWidth_m, 1e-6);
  bench.at(1.0, {1, 0.25, 0.8});
  EXPECT_NEAR(bench.result("min_clearance_m"), 1.5 - 0.25 - kHalfWidth_m, 1e-6);
  bench.at(2.0, {2, -1.0, 0.8});
  EXPECT_NEAR(bench.result("min_clearance_m"), 1.5 - 0.25 - kHalfWidth_m, 1e-6)
      << "keeps the least";
  EXPECT_EQ(bench.result("contact_count"), 0.0);
}

/// It looks only where a new minimum is possible, and no farther than it matters: the minimum must
/// not suffer.
TEST(Clearance, FollowsTheLeastGapOfAWeavingHull) {
  Bench bench({hedge()});
  double least_m = 1e9;
  for (int k = 0; k < 4000; ++k) {
    // Nearer and away again, each time a little nearer, at up to 3 cm a tick.
    const double y = -1.0 + 0.8 * std::sin(0.03 * k) + 0.0002 * k;
    bench.at(0.1 * k, {0.0, y, 0.8});
    least_m = std::min(least_m, 1.5 - kHalfWidth_m - y);
    ASSERT_NEAR(bench.result("min_clearance_m"), least_m, 1e-6) << "tick " << k;
  }
  EXPECT_LT(least_m, 0.6);
}

TEST(Clearance, KnowsWhereTheHullIsInTheBody) {
  Bench bench({hedge()});
  // Turned to face the hedge: the hull's length and its centre ahead of B count.
  bench.at(0.0, {0, 0, 0.8}, kPi / 2);
  EXPECT_NEAR(bench.result("min_clearance_m"), 1.5 - kAhead_m - kHalfLength_m, 1e-6);
}

TEST(Clearance, IsMeasuredInSpace) {
  Bench bench({hedge()});
  // Above the hedge's near edge (y 1.5, z 1.5): 0.3 m beside it and 0.4 m over it, 0.5 m in all.
  bench.at(0.0, {0, 1.5 - kHalfWidth_m - 0.3, 1.5 + kHalfHeight_m - kUp_m + 0.4});
  EXPECT_NEAR(bench.result("min_clearance_m"), 0.5, 1e-6);
}

TEST(Clearance, PostsTrunksAndWiresCountAndCratesDoNot) {
  for (const SurfaceClass surface :
       {SurfaceClass::kPost, SurfaceClass::kTrunk, SurfaceClass::kWire, SurfaceClass::kCanopy}) {
    Bench bench(
        {make_instance("thing", make_box_mesh({5.0f, 0.0025f, 0.0025f}), {0, 1.0, 0.9}, surface)});
    bench.at(0.0, {0, 0, 0.8});
    EXPECT_NEAR(bench.result("min_clearance_m"), 1.0 - 0.0025 - kHalfWidth_m, 1e-6)
        << to_string(surface);
  }
  for (const SurfaceClass surface : {SurfaceClass::kObstacle, SurfaceClass::kTerrain}) {
    Bench bench(
        {make_instance("thing", make_box_mesh({5.0f, 0.1f, 0.1f}), {0, 1.0, 0.9}, surface)});
    bench.at(0.0, {0, 0, 0.8});
    EXPECT_TRUE(std::isnan(bench.result("min_clearance_m"))) << to_string(surface);
  }
}

TEST(Clearance, IsNotMeasuredWhereNothingWasNear) {
  Bench empty({});
  empty.at(0.0, {0, 0, 0.8});
  EXPECT_TRUE(std::isnan(empty.result("min_clearance_m")));
  EXPECT_EQ(empty.result("contact_count"), 0.0);

  Bench short_sighted({hedge()}, 1.0);
  short_sighted.at(0.0, {0, 0, 0.8});  // 1.1 m away
  EXPECT_TRUE(std::isnan(short_sighted.result("min_clearance_m")));
  short_sighted.at(1.0, {0, 0.15, 0.8});
  EXPECT_NEAR(short_sighted.result("min_clearance_m"), 0.95, 1e-6);
}

TEST(Clearance, LeavesAreATouchOncePerHalfSecond) {
  Bench bench({hedge()});
  const auto count = [&] { return bench.result("canopy_contact_count"); };
  bench.at(0.0, {0, 1.0, 0.8});  // 0.1 m away
  EXPECT_EQ(count(), 0.0);
  bench.at(1.0, {0, 1.15, 0.8});
  EXPECT_EQ(count(), 1.0);
  EXPECT_EQ(bench.result("min_clearance_m"), 0.0);
  bench.at(1.1, {0, 1.0, 0.8});
  bench.at(1.5, {0, 1.15, 0.8});  // 0.5 s after the last touch: the same one
  EXPECT_EQ(count(), 1.0);
  bench.at(1.55, {0, 0.9, 0.8});
  bench.at(2.1, {0, 1.15, 0.8});
  EXPECT_EQ(count(), 2.0);
  for (int k = 1; k <= 20; ++k) bench.at(2.1 + 0.05 * k, {0.1 * k, 1.15, 0.8});
  EXPECT_EQ(count(), 2.0) << "brushing along is one touch";
}

TEST(Clearance, TouchesOfLeavesAndOfRigidThingsAreAddedUp) {
  Bench bench({hedge()});
  bench.rigid_touches(3.0);
  bench.at(0.0, {0, 1.15, 0.8});
  EXPECT_EQ(bench.result("canopy_contact_count"), 1.0);
  EXPECT_EQ(bench.result("contact_count"), 4.0);
}

TEST(Clearance, APostIsNoTouchOfLeaves) {
  Bench bench({make_instance("post", make_box_mesh({0.1f, 0.1f, 1.0f}), {0, 0.3, 1.0},
                             SurfaceClass::kPost)});
  bench.at(0.0, {0, 0, 0.8});
  EXPECT_EQ(bench.result("min_clearance_m"), 0.0);
  EXPECT_EQ(bench.result("contact_count"), 0.0) << "the physics counts it";
}

TEST(Clearance, LeavesThatAreBrushedBetweenTwoTicksCount) {
  // A shoot of 2 cm hangs between two poses 3 m apart, 0.1 m inside the hull's side.
  Bench bench({make_instance("shoot", make_box_mesh({0.01f, 0.1f, 0.01f}), {1.6, 0.4, 1.0},
                             SurfaceClass::kCanopy)});
  bench.at(0.0, {0, 0, 0.8});
  EXPECT_NEAR(bench.result("min_clearance_m"), 1.6 - 0.01 - kAhead_m - kHalfLength_m, 1e-6);
  bench.at(0.05, {3, 0, 0.8});
  EXPECT_EQ(bench.result("min_clearance_m"), 0.0);
  EXPECT_EQ(bench.result("canopy_contact_count"), 1.0);
}

TEST(Clearance, PassingBetweenTwoTicksTellsTheLeastGap) {
  // The shoot's tip is 0.2 m beside the hull's way.
  Bench bench({make_instance("shoot", make_box_mesh({0.01f, 0.1f, 0.01f}), {1.6, 0.7, 1.0},
                             SurfaceClass::kCanopy)});
  bench.at(0.0, {0, 0, 0.8});
  bench.at(0.05, {3, 0, 0.8});
  EXPECT_NEAR(bench.result("min_clearance_m"), 0.7 - 0.1 - kHalfWidth_m, 1e-6);
  EXPECT_EQ(bench.result("contact_count"), 0.0);
}

TEST(Clearance, ATouchOfLeavesIsAnEvent) {
  Bench bench({hedge()});
  bench.at(0.0, {0, 1.0, 0.8});
  EXPECT_FALSE(bench.event().has_value());
  bench.at(1.0, {2, 1.15, 0.8});
  ASSERT_TRUE(bench.event().has_value());
  EXPECT_EQ(bench.event().value().level, Event::Level::kWarning);
  EXPECT_EQ(bench.event().value().source, "rover.metrics.clearance");
  EXPECT_THAT(bench.event().value().text, HasSubstr("brushes the canopy"));
}

}  // namespace
}  // namespace vinerow::metrics::clearance_test
