// What every registered controller of ground vehicles keeps, and every estimator and planner that
// feeds it. Controllers of flying vehicles: flight_conformance_test.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/messages/camera.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/mission.h"
#include "tests/controllers/support/row_mesh_map.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::conformance_test {
namespace {

/// Two alleys of 20 m, 5 m apart, and the turn between them; rotated and mirrored about the origin.
MissionSetup make_small_mission(const std::string& controller, double angle_rad = 0.0,
                                bool mirrored = false) {
  const Eigen::Rotation2Dd R(angle_rad);
  const auto place = [&](double x, double y) {
    const Eigen::Vector2d p = R * Eigen::Vector2d(x, mirrored ? -y : y);
    return Eigen::Vector3d(p.x(), p.y(), 0.0);
  };
  MissionSetup setup;
  setup.map->alleys = {{0, {place(0, 0), place(20, 0)}, 5.0},
                       {1, {place(0, 5), place(20, 5)}, 5.0}};
  setup.map->rows.resize(1);
  setup.map->rows[0].line_W = {place(0, 2.5), place(20, 2.5)};
  const Eigen::Vector3d start = place(-0.5, 0.2);
  setup.start = {start.head<2>(), (mirrored ? -0.1 : 0.1) + angle_rad};
  setup.planner.values = {{"approach", false}};
  setup.controller.type = controller;
  setup.longest_s = 200.0;
  return setup;
}

class EveryController : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryController, FinishesNearThePathsEndWithFiniteCommands) {
  const MissionResult result = run_mission(make_small_mission(GetParam()));
  EXPECT_TRUE(result.finished);
  for (const controllers::Pose2& pose : result.poses) {
    ASSERT_TRUE(pose.p.allFinite() && std::isfinite(pose.yaw_rad));
  }
  EXPECT_LT((result.poses.back().p - Eigen::Vector2d(0, 5)).norm(), 0.15);
}

TEST_P(EveryController, DrivesTheSameBitsTwice) {
  MissionSetup setup = make_small_mission(GetParam());
  setup.estimator = {"odometry_filter", {{"heading", std::string("truth")}}};
  setup.accuracy_m = 0.05;
  const MissionResult a = run_mission(setup), b = run_mission(setup);
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    ASSERT_EQ(a.poses[i].p, b.poses[i].p);
    ASSERT_EQ(a.poses[i].yaw_rad, b.poses[i].yaw_rad);
  }
  setup.seed = 2;
  EXPECT_NE(run_mission(setup).poses.back().p, a.poses.back().p);
}

TEST_P(EveryController, DoesNotCareForDirectionOrSide) {
  const MissionResult straight = run_mission(make_small_mission(GetParam()));
  for (const bool mirrored : {false, true}) {
    for (const double angle : {0.0, 0.5 * kPi, kPi, -2.0}) {
      const MissionResult turned = run_mission(make_small_mission(GetParam(), angle, mirrored));
      ASSERT_EQ(turned.poses.size(), straight.poses.size());
      for (std::size_t i = 0; i < straight.poses.size(); ++i) {
        Eigen::Vector2d p = Eigen::Rotation2Dd(-angle) * turned.poses[i].p;
        if (mirrored) p.y() = -p.y();
        // Rounding of rotated coordinates, not amplified by a stable follower.
        ASSERT_NEAR((p - straight.poses[i].p).norm(), 0.0, 1e-9) << angle << mirrored << i;
      }
    }
  }
}

/// A controller alone between signals.
struct Bench : Loop {
  explicit Bench(const std::string& type) : Bench(type, vehicle_for(type)) {}
  Bench(const std::string& type, VehicleDescription vehicle)
      : Loop({.description = std::move(vehicle)}) {
    add_controller({type, {}});
  }
  /// No wheel turns. Steered axles may stand as they are.
  void expect_standing() const {
    const NamedValues& values = read<NamedValues>("actuators");
    int wheels = 0;
    for (std::size_t i = 0; i < values.names.size(); ++i) {
      if (!values.names[i].ends_with("_speed_radps")) continue;
      EXPECT_EQ(values.values[i], 0.0) << values.names[i];
      ++wheels;
    }
    EXPECT_GT(wheels, 0);
  }
};

TEST_P(EveryController, StandsStillWithoutPlanOrEstimate) {
  Bench bench(GetParam());
  bench.step();
  bench.step(Odometry{});
  bench.expect_standing();
  EXPECT_FALSE(bench.finished());
}

TEST_P(EveryController, TakesPlansOfOnePointAndOfNone) {
  for (const int points : {0, 1}) {
    Bench bench(GetParam());
    PlannedPath plan;
    plan.points.resize(points);
    bench.give_plan(plan);
    bench.step(Odometry{});
    bench.expect_standing();
  }
}

TEST_P(EveryController, AllocatesNothingAfterTakingThePlan) {
  Bench bench(GetParam());
  bench.give_plan(plan_mission(make_small_mission(GetParam())));
  bench.step(Odometry{});
  Odometry pose;
  std::size_t allocations = 0;
  {
    AllocationCounter counter;
    for (int i = 1; i < 400; ++i) {
      pose.X_WB.p.x() = 0.05 * i;
      bench.step(pose);
    }
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(bench.follower().distance_m, 15.0);
}

TEST_P(EveryController, StandsStillAfterTheEnd) {
  Bench bench(GetParam());
  const PlannedPath plan = plan_mission(make_small_mission(GetParam()));
  bench.give_plan(plan);
  Odometry pose;
  for (int i = 0; i <= static_cast<int>(plan.points.size()) + 20; ++i) {
    const PathPoint& at = plan.points[std::min<std::size_t>(i, plan.points.size() - 1)];
    pose.X_WB = {quaternion_from_rpy({0, 0, at.yaw_rad}), at.p_W};
    bench.step(pose);
  }
  EXPECT_TRUE(bench.finished());
  EXPECT_TRUE(bench.follower().finished);
  bench.expect_standing();
}

TEST_P(EveryController, StandsWhereItsAuthorityEndsAndGoesOnFromThere) {
  for (const double side : {-1.0, 1.0}) {
    MissionSetup setup = make_small_mission(GetParam(), 0.0, side < 0.0);
    // The middle of the first leg, then that of the second, behind the half circle of 2.5 m.
    const double second_m = 20.0 + 2.5 * kPi + 10.0;
    setup.stop_at_m = [=](double time_s) {
      if (time_s < 30.0) return 10.0;
      return time_s < 90.0 ? second_m : std::numeric_limits<double>::infinity();
    };
    const MissionResult result = run_mission(setup);
    EXPECT_TRUE(result.finished);
    EXPECT_GT(result.time_s, 90.0);
    const auto x_at = [&](double time_s) {
      return result.poses[static_cast<std::size_t>(std::lround(time_s / setup.cycle_s))].p.x();
    };
    for (double time_s = 0.0; time_s < 30.0; time_s += setup.cycle_s) {
      ASSERT_LE(x_at(time_s), 10.1) << time_s;
    }
    for (double time_s = 50.0; time_s < 90.0; time_s += setup.cycle_s) {
      ASSERT_GE(x_at(time_s), 9.9) << time_s;
    }
    EXPECT_GE(x_at(25.0), 9.7);
    EXPECT_LE(x_at(80.0), 10.3);
    EXPECT_EQ(x_at(25.0), x_at(29.9));
    EXPECT_EQ(x_at(80.0), x_at(89.9));
    EXPECT_GT(x_at(35.0), 12.0);
    EXPECT_LT((result.poses.back().p - Eigen::Vector2d(0, side * 5)).norm(), 0.15);
  }
}

TEST_P(EveryController, DoesNotBeginWithoutAuthority) {
  Bench bench(GetParam());
  bench.give_plan(plan_mission(make_small_mission(GetParam())));
  for (int i = 0; i < 100; ++i) {
    bench.write("authority", MovementAuthority{-2.0, 0, "other"});
    bench.step(Odometry{});
    bench.expect_standing();
  }
  EXPECT_FALSE(bench.finished());
  EXPECT_FALSE(bench.follower().finished);
  bench.give_authority(10.0);
  bench.step();
  double fastest = 0.0;
  for (const double value : bench.actuators()) fastest = std::max(fastest, value);
  EXPECT_GT(fastest, 0.0);
}

TEST_P(EveryController, IsTheSameWithEndlessAuthorityAsWithout) {
  MissionSetup setup = make_small_mission(GetParam());
  const MissionResult without = run_mission(setup);
  setup.stop_at_m = [](double) { return std::numeric_limits<double>::infinity(); };
  const MissionResult with = run_mission(setup);
  ASSERT_EQ(with.poses.size(), without.poses.size());
  for (std::size_t i = 0; i < with.poses.size(); ++i) {
    ASSERT_EQ(with.poses[i].p, without.poses[i].p);
  }
}

TEST_P(EveryController, RefusesVehiclesItCannotSteer) {
  VehicleDescription description;
  description.type = "quadrotor";
  description.actuators = {{"rotor_1_speed_radps", "rad/s", 0.0, 900.0}};
  try {
    Bench bench(GetParam(), description);
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find("rover.controller (" + GetParam() + ") steers by"), 0u) << text;
    EXPECT_NE(text.find("rotor_1_speed_radps"), std::string::npos);
  }
}

TEST_P(EveryController, DocumentsItsParameters) {
  for (const ParameterSpec& parameter :
       parts().spec(PartKind::kController, GetParam()).parameters) {
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Controllers, EveryController,
                         ::testing::ValuesIn(parts_that_read(PartKind::kController, "plan")),
                         [](const auto& test) { return test.param; });

/// Controllers that take commands from outside the run.
std::vector<std::string> remote_controllers() {
  std::vector<std::string> names;
  for (const char* signal : {"cmd_vel", "actuator_command"}) {
    for (const std::string& name : parts_that_read(PartKind::kController, signal)) {
      names.push_back(name);
    }
  }
  return names;
}

class EveryRemoteController : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryRemoteController, StandsWithoutCommands) {
  Bench bench(GetParam());
  for (int i = 0; i < 5; ++i) bench.step();
  bench.expect_standing();
  EXPECT_FALSE(bench.finished());
}

INSTANTIATE_TEST_SUITE_P(Controllers, EveryRemoteController,
                         ::testing::ValuesIn(remote_controllers()),
                         [](const auto& test) { return test.param; });

TEST(Controllers, AreEachRunByOneOfTheFourSuites) {
  const std::vector<std::string> ground = parts_that_read(PartKind::kController, "plan"),
                                 rotors = parts_that_write(PartKind::kController, "wrench"),
                                 wings = parts_that_write(PartKind::kController, "deviation"),
                                 remote = remote_controllers();
  for (const std::string& name : parts().names(PartKind::kController)) {
    EXPECT_EQ(std::count(ground.begin(), ground.end(), name) +
                  std::count(rotors.begin(), rotors.end(), name) +
                  std::count(wings.begin(), wings.end(), name) +
                  std::count(remote.begin(), remote.end(), name),
              1)
        << name << " must read \"plan\" or commands from outside, or write either \"wrench\" or "
        << "\"deviation\"";
  }
  EXPECT_GE(ground.size(), 3u);
  EXPECT_GE(rotors.size(), 2u);
  EXPECT_GE(wings.size(), 2u);
  EXPECT_GE(remote.size(), 2u);
}

class EveryEstimator : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryEstimator, AllocatesNothing) {
  const RowMeshBlock block{.rows = 4, .length_m = 40.0};
  const RowMap map = make_row_mesh_map(block, RandomStream(1, "", "map"));
  Loop loop({.map = &map,
             .sensors = {{"sonar", "ultrasound", {quaternion_from_rpy({0, 0, 0.8}), {0, 0, 1}}},
                         {"camera", "camera", {quaternion_from_rpy({0, 0.3, 0}), {0, 0, 1}}}}});
  loop.add_estimator({GetParam(), {}});
  // On the ground of an alley, where the sonar has a wall of the map before it.
  Odometry place;
  place.X_WB.p = row_mesh_ground(block, 20.0, 1.25);
  ImuSample sample;
  sample.f_WS_S.z() = 9.80665;
  GnssFix fix;
  fix.valid = true;
  fix.p_W = place.X_WB.p;
  RangeSample echo;
  echo.range_m = 1.0;
  echo.max_range_m = 4.0;
  NamedValues wheels;
  for (const ActuatorSpec& actuator : loop.description().actuators) {
    wheels.names.push_back(actuator.name);
    wheels.values.push_back(1.0);
  }
  // Trunks before ground, in every column.
  CameraInfo info;
  info.width = info.height = 32;
  info.fx_px = info.fy_px = 16.0;
  info.cx_px = info.cy_px = 15.5;
  Picture labels;
  labels.width = labels.height = 32;
  labels.format = Picture::Format::kMono8;
  labels.data.assign(32 * 32, static_cast<std::uint8_t>(Label::kGround));
  std::fill_n(labels.data.begin(), 32 * 24, static_cast<std::uint8_t>(Label::kWood));
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      loop.write("encoders", wheels);
      loop.write("camera_info", info);
      loop.write("camera_semantic", labels);
      loop.write("truth", place);
      loop.write("command", VelocityCommand{1.0, 0.1});
      loop.write("imu", sample);
      loop.write("gps", fix);
      loop.write("ins", place);
      loop.write("sonar", echo);
      loop.step();
    }
  };
  run(1);  // signals with names take their memory when they are first written
  std::size_t allocations = 0;
  {
    AllocationCounter counter;
    run(999);
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_TRUE(loop.read<Odometry>("estimate").X_WB.p.allFinite());
}

INSTANTIATE_TEST_SUITE_P(Estimators, EveryEstimator,
                         ::testing::ValuesIn(parts().names(PartKind::kEstimator)),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace vinerow::test::conformance_test
