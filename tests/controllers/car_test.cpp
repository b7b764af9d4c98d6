// A small tractor from a URDF file, steered by its front wheels, under both followers that drive by
// speed and yaw rate.

#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <memory>
#include <string>

#include "engine/core/error.h"
#include "tests/support/paths.h"
#include "vinerow/testing.h"

namespace vinerow::test::car_test {
namespace {

using vinerow::testing::SmallWorld;

/// Four rows of 30 m on flat ground, 4 m apart. @param spawn  "x_m: 0, y_m: 0"
SmallWorld make_world(const std::string& controller, const std::string& spawn) {
  SmallWorld world;
  world
      .world("vineyard",
             "row_count: 4, row_length_m: 30, pitch_m: 4, relief_m: 0, waves_m: 0, "
             "surroundings_m: 120, row_bearing_deg: 90")
      .vehicle("tractor", "urdf_rover",
               "urdf: " + std::string(VINEROW_SOURCE_DIR) +
                   "/tests/vehicles/data/plain_car.urdf, max_speed_mps: 2, spawn: {" + spawn + "}")
      .controller("tractor", controller, "speed_mps: 1.2")
      .duration_s(400.0);
  return world;
}

/// Runs to the end, which must be the plan's. @returns the tractor's metrics
std::map<std::string, double> drive(const SmallWorld& world) {
  auto run = world.build();
  run.run_to_end();
  EXPECT_TRUE(run.finished());
  return run.metrics("tractor");
}

class CarFollower : public ::testing::TestWithParam<const char*> {};

TEST_P(CarFollower, DrivesRoundedCorners) {
  const auto metrics = drive(make_world(GetParam(), "x_m: -20, y_m: -60, yaw_deg: 0")
                                 .planner("tractor", "waypoints",
                                          "x_m: [-20, 0, 0, 17.32, 0, 20, 5.86], "
                                          "y_m: [-60, -60, -40, -50, -50, -50, -64.14]"));
  std::printf("%s: %.4f m rms, %.4f m at most\n", GetParam(), metrics.at("cross_track_rms_m"),
              metrics.at("cross_track_max_m"));
  // The worst is where an arc meets a straight and the axle swings over at its rate.
  EXPECT_LT(metrics.at("cross_track_rms_m"), 0.06);
  EXPECT_LT(metrics.at("cross_track_max_m"), 0.25);
}

TEST_P(CarFollower, WorksTheAlleys) {
  const auto metrics = drive(make_world(GetParam(), "alley: 0, offset_m: 1.0")
                                 .planner("tractor", "coverage", "approach: false, turn: dubins"));
  std::printf("%s: clearance %.3f m\n", GetParam(), metrics.at("min_clearance_m"));
  EXPECT_EQ(metrics.at("alleys_driven"), 3.0);
  EXPECT_EQ(metrics.at("contact_count"), 0.0);
  EXPECT_GT(metrics.at("min_clearance_m"), 0.8);
}

TEST_P(CarFollower, IsNotAskedForTighterTurnsThanItCan) {
  // A semicircle between alleys 4 m apart has 2 m.
  auto run = make_world(GetParam(), "alley: 0, offset_m: 1.0")
                 .planner("tractor", "coverage", "approach: false")
                 .build();
  try {
    run.run_to_end();
    FAIL() << "must be refused";
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("has a radius of 2 m, below turn_radius_m = 2.49"),
              std::string::npos)
        << error.what();
  }
}

/// There and to the left, with a corner of 90 deg.
class SharpPlanner final : public Planner {
 public:
  Result<PlannedPath> plan(const Pose& start) override {
    PlannedPath path;
    for (const Eigen::Vector2d& step : {Eigen::Vector2d(0, 0), {10, 0}, {10, 10}}) {
      PathPoint point;
      point.p_W = start.p + Eigen::Vector3d(step.x(), step.y(), 0.0);
      path.points.push_back(point);
    }
    return path;
  }
};

TEST_P(CarFollower, RefusesAPlanThatTurnsOnTheSpot) {
  PartSpec spec;
  spec.name = "sharp";
  auto run = make_world(GetParam(), "x_m: -20, y_m: -60, yaw_deg: 0")
                 .planner("tractor", spec,
                          [](const ParameterSet&, const PlannerContext&) {
                            return std::make_unique<SharpPlanner>();
                          })
                 .build();
  run.run_to_end();
  EXPECT_FALSE(run.finished());
  EXPECT_LT(run.time_s(), 5.0);
  const auto crashes = run.session().crashes();
  ASSERT_EQ(crashes.size(), 1u);
  EXPECT_EQ(crashes[0].text,
            "the plan turns by 90 deg at (-10.00, -60.00), and a vehicle that steers by its front "
            "axle cannot turn on the spot");
}

INSTANTIATE_TEST_SUITE_P(Parts, CarFollower, ::testing::Values("pure_pursuit", "path_follower"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace vinerow::test::car_test
