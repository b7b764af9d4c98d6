#include "vehicles/diff_drive_rover/diff_drive_rover.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/vehicles/small_worlds.h"
#include "vehicles/diff_drive_rover/kinematic_rover.h"

namespace vinerow::vehicles::diff_drive_rover_test {
namespace {

using namespace test;

TEST(KinematicRover, ArcIsExactOnAnyTerrain) {
  const WorldModel model = make_world(
      60.0, 0.5, [](double x, double y) { return 0.3 * std::sin(0.4 * x) + 0.02 * x * y; });
  physics::PhysicsWorld world({}, model);
  KinematicRover rover{DiffDriveRoverParams{}};
  rover.spawn(world, pose_on_ground(model, 1.0, 2.0, 0.3, 0.38));
  const Odometry start = [&] {
    Odometry truth;
    rover.read_truth(truth);
    return truth;
  }();
  // v = 1.5 m/s, w = 0.5 rad/s: radius 3 m, whatever the ground does.
  const double v = 1.5, w = 0.5;
  const std::vector<double> values = {(v - 0.5 * w) / 0.2, (v + 0.5 * w) / 0.2, (v - 0.5 * w) / 0.2,
                                      (v + 0.5 * w) / 0.2};
  rover.actuate(values);
  const Duration dt{1'000'000};
  for (int i = 0; i < 4000; ++i) {
    rover.before_physics({}, dt);
    world.step(dt);
    rover.after_physics({}, dt);
  }
  Odometry truth;
  rover.read_truth(truth);
  const double yaw0 = yaw_from_quaternion(start.X_WB.q), yaw = yaw0 + w * 4.0;
  const double x = start.X_WB.p.x() + v / w * (std::sin(yaw) - std::sin(yaw0));
  const double y = start.X_WB.p.y() - v / w * (std::cos(yaw) - std::cos(yaw0));
  EXPECT_NEAR(truth.X_WB.p.x(), x, 1e-12);  // round-off of 4000 additions
  EXPECT_NEAR(truth.X_WB.p.y(), y, 1e-12);
  EXPECT_NEAR(wrap_angle(yaw_from_quaternion(truth.X_WB.q) - yaw), 0.0, 1e-12);
  // And it stands on the ground: its wheels' mean height is that of the terrain under it.
  EXPECT_NEAR(truth.X_WB.p.z(), model.terrain->height_m(x, y) + 0.38, 0.05);
}

TEST(KinematicRover, StandsOnceItsBatteryIsEmpty) {
  DiffDriveRoverParams params;
  params.battery.capacity_Wh = 0.1;  // 360 J
  const WorldModel model = make_flat_world();
  physics::PhysicsWorld world({}, model);
  KinematicRover rover{params};
  rover.spawn(world, pose_on_ground(model, 0.0, 0.0, 0.0, 0.38));
  const Duration dt{1'000'000};
  for (int i = 0; i < 6000; ++i) {
    rover.actuate(std::vector<double>(4, 5.0));
    rover.before_physics({}, dt);
    world.step(dt);
    rover.after_physics({}, dt);
  }
  // At 1 m/s against a rolling resistance of 6 %, with 85 % efficiency and 30 W of electronics.
  const double power_W = 0.06 * 180.0 * 9.80665 * 1.0 / 0.85 + 30.0;
  Odometry truth;
  rover.read_truth(truth);
  EXPECT_NEAR(truth.X_WB.p.x(), 360.0 / power_W, 0.002);  // a step or two of 1 mm
  EXPECT_EQ(truth.v_WB_B.norm(), 0.0);
  EXPECT_EQ(rover.actuator_states()[0], 0.0);
}

TEST(DiffDriveRover, TellsPaperBsTableOne) {
  const DiffDriveRover rover{DiffDriveRoverParams{}};
  const VehicleDescription& about = rover.description();
  EXPECT_EQ(about.wheeled->wheel_base_m, 1.5);
  EXPECT_EQ(about.wheeled->track_m, 1.0);
  EXPECT_EQ(about.wheeled->wheel_radius_m, 0.2);
  EXPECT_EQ(about.min_turning_radius_m, 1.0);
  EXPECT_EQ(about.battery_capacity_J, 3600e3);  // 1000 Wh
  EXPECT_DOUBLE_EQ(about.max_speed_mps.value(), 7.0 / 3.6);
  ASSERT_EQ(about.actuators.size(), 4u);
  EXPECT_EQ(about.actuators[0].name, "wheel_fl_speed_radps");
  EXPECT_EQ(about.actuators[3].name, "wheel_rr_speed_radps");
  EXPECT_GE(about.actuators[0].max, 19.0);  // what the paper's follower asks for with noise
}

TEST(DiffDriveRover, LinksTurnWithTheWheels) {
  const WorldModel model = make_flat_world();
  for (const bool kinematic : {false, true}) {
    physics::PhysicsWorld world({}, model);
    ParameterSet parameters(diff_drive_rover_spec().parameters, "diff_drive_rover");
    parameters.set("fidelity", kinematic ? "kinematic" : "physics");
    const auto rover = make_diff_drive_rover(parameters, {});
    ASSERT_EQ(dynamic_cast<KinematicRover*>(rover.get()) != nullptr, kinematic);
    rover->spawn(world, pose_on_ground(model, 0, 0, 0, 0.38));
    rover->actuate(std::vector<double>{2, 2, 2, 2});
    const Duration dt{1'000'000};
    for (int i = 0; i < 500; ++i) {
      rover->before_physics({}, dt);
      world.step(dt);
      rover->after_physics({}, dt);
    }
    std::vector<Pose> poses(rover->links().size());
    rover->read_links(poses);
    ASSERT_EQ(poses.size(), 5u);
    EXPECT_NEAR(poses[1].p.z(), 0.2, 2e-3);  // hubs at wheel radius
    EXPECT_NEAR(poses[1].p.y(), 0.5, 1e-3);
    EXPECT_NEAR(poses[2].p.y(), -0.5, 1e-3);
    // Rolling forward turns about +y: the wheel's x axis has gone down.
    EXPECT_LT((poses[1].q * Eigen::Vector3d::UnitX()).z(), -0.5);
  }
}

TEST(DiffDriveRoverParams, RejectsBadNumbersByName) {
  ParameterSet set(diff_drive_rover_spec().parameters, "diff_drive_rover");
  try {
    set.set("mass_kg", -2.0);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("mass_kg = -2 kg, must be > 0 kg"), std::string::npos)
        << error.what();
  }
  DiffDriveRoverParams params;
  params.inertia_kgm2 = {1.0, -1.0, 1.0};
  try {
    params.validate();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "rover: inertia_kgm2[1] = -1 kg m2, must be > 0 kg m2");
  }
  params.inertia_kgm2 = {1.0, 70.0, 8.0};
  try {
    params.validate();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "rover: inertia_kgm2 = [1, 70, 8] is not possible for a rigid body: one moment is "
                 "larger than the sum of the other two");
  }
}

}  // namespace
}  // namespace vinerow::vehicles::diff_drive_rover_test
