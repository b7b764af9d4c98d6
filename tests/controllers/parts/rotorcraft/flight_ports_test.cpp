#include "controllers/parts/rotorcraft/flight_ports.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "tests/controllers/support/quadrotor_sim.h"

namespace vinerow::controllers::flight_ports_test {
namespace {

using Phase = ReferenceTrajectory::Phase;

struct Bench {
  explicit Bench(VehicleDescription d = test::describe(test::make_q4t()))
      : description(std::move(d)), ports(context(), "test") {
    Ports world(bus, "drone", "test");
    estimate = world.write<Odometry>("estimate");
    reference = world.write<ReferenceTrajectory>("reference");
    Ports part(bus, "drone", "drone.controller");
    ports.connect(part);
    actuators = world.read<NamedValues>("actuators");
    wrench = world.read<NamedValues>("wrench");
    follower = world.read<FollowerState>("follower");
  }
  ControllerContext context() const {
    ControllerContext context;
    context.part = "drone.controller";
    context.period = Duration{4'000'000};
    context.vehicle_description = &description;
    return context;
  }
  VehicleDescription description;
  SignalBus bus;
  FlightPorts ports;
  SignalWriter<Odometry> estimate;
  SignalWriter<ReferenceTrajectory> reference;
  SignalReader<NamedValues> actuators, wrench;
  SignalReader<FollowerState> follower;
};

/// A cubic in time along each axis and its derivatives.
TrajectoryPoint cubic(double t) {
  const Eigen::Vector3d a(1, -2, 0.5), b(3, 1, -1), c(0.2, 0.4, -0.3), d(0.5, -0.1, 0.2);
  TrajectoryPoint point;
  point.p_W = a + b * t + c * t * t + d * t * t * t;
  point.v_W = b + 2 * c * t + 3 * d * t * t;
  point.a_W = 2 * c + 6 * d * t;
  point.yaw_rad = 3.0 + 0.5 * t;
  point.yaw_rate_radps = 0.5;
  return point;
}

TEST(FlightPorts, ReadsTheReferenceBetweenItsPoints) {
  Bench bench;
  ReferenceTrajectory trajectory;
  trajectory.dt_s = 0.05;
  for (int i = 0; i < 5; ++i) trajectory.points.push_back(cubic(0.05 * i));
  bench.reference.write(Time{1'000'000'000}, trajectory);
  for (const double t : {0.0, 0.01, 0.05, 0.123, 0.2}) {
    const TrajectoryPoint at = bench.ports.reference_at(Time{} + duration_from_s(1.0 + t));
    const TrajectoryPoint expected = cubic(t);
    EXPECT_LT((at.p_W - expected.p_W).norm(), 1e-12) << t;  // Hermite pieces are exact for cubics
    EXPECT_LT((at.v_W - expected.v_W).norm(), 3.0 * 0.05 * 0.05 / 4.0) << t;
    EXPECT_LT((at.a_W - expected.a_W).norm(), 1e-12) << t;
    EXPECT_NEAR(at.yaw_rad, expected.yaw_rad, 1e-12) << t;
    EXPECT_EQ(at.yaw_rate_radps, 0.5);
  }
  // A guidance that fell silent: stay at the last point.
  const TrajectoryPoint late = bench.ports.reference_at(Time{2'000'000'000});
  EXPECT_EQ(late.p_W, trajectory.points.back().p_W);
  EXPECT_EQ(late.v_W, Eigen::Vector3d::Zero());
  // Before its stamp it has not begun.
  EXPECT_EQ(bench.ports.reference_at(Time{}).p_W, trajectory.points.front().p_W);
}

TEST(FlightPorts, FliesInAllPhasesButTheFirstAndTheLast) {
  Bench bench;
  EXPECT_FALSE(bench.ports.is_flying());
  ReferenceTrajectory trajectory;
  trajectory.phase = Phase::kRow;
  bench.reference.write(Time{}, trajectory);
  bench.estimate.write(Time{}, Odometry{});
  EXPECT_FALSE(bench.ports.is_flying()) << "a reference without points";
  trajectory.points.resize(2);
  for (int phase = 0; phase <= 8; ++phase) {
    trajectory.phase = static_cast<Phase>(phase);
    bench.reference.write(Time{}, trajectory);
    const bool still = trajectory.phase == Phase::kWait || trajectory.phase == Phase::kDone;
    EXPECT_EQ(bench.ports.is_flying(), !still) << phase;
    EXPECT_EQ(bench.ports.is_done(), trajectory.phase == Phase::kDone) << phase;
  }
}

TEST(FlightPorts, SeesTheLiftOff) {
  Bench bench;
  ReferenceTrajectory trajectory;
  trajectory.points.resize(2);
  trajectory.phase = Phase::kTakeOff;
  bench.reference.write(Time{}, trajectory);
  Odometry odometry;
  bench.estimate.write(Time{}, odometry);
  bench.ports.write(Time{}, {15.0, {0, 0, 0}});
  EXPECT_FALSE(bench.ports.has_lifted_off());
  odometry.v_WB_B.z() = 0.2;
  bench.estimate.write(Time{}, odometry);
  bench.ports.write(Time{}, {21.0, {0, 0, 0}});
  EXPECT_TRUE(bench.ports.has_lifted_off());
  odometry.v_WB_B.z() = 0.0;
  bench.estimate.write(Time{}, odometry);
  bench.ports.write(Time{}, {21.0, {0, 0, 0}});
  EXPECT_TRUE(bench.ports.has_lifted_off());
  bench.ports.write_off(Time{});
  EXPECT_FALSE(bench.ports.has_lifted_off());
}

TEST(FlightPorts, WritesSpeedsWrenchAndErrors) {
  Bench bench;
  ReferenceTrajectory trajectory;
  trajectory.points.resize(2);
  trajectory.phase = Phase::kRow;
  trajectory.points[0].yaw_rad = 7.0;
  trajectory.points[0].v_W = {0.0, 3.0, 0.0};  // flies north
  trajectory.distance_m = 4.0;
  trajectory.remaining_m = 5.0;
  bench.reference.write(Time{}, trajectory);
  Odometry odometry;
  odometry.X_WB.p = {-0.3, 1.0, 0.0};  // west of it is left of it
  odometry.X_WB.q = quaternion_from_rpy({0.0, 0.0, 7.1});
  bench.estimate.write(Time{}, odometry);
  const Wrench reached = bench.ports.write(Time{}, {20.0, {0.1, 0.2, 9.0}});
  EXPECT_EQ(bench.actuators.value().names[3], "rotor_4_speed_radps");
  EXPECT_GT(bench.actuators.value().values[0], 286.0);  // it turns to the left
  EXPECT_LT(bench.actuators.value().values[1], 286.0);
  const NamedValues& wrench = bench.wrench.value();
  EXPECT_EQ(wrench.names[3], "wanted_torque_z_Nm");
  EXPECT_EQ(wrench.values[3], 9.0);
  EXPECT_EQ(wrench.names[7], "reachable_torque_z_Nm");
  EXPECT_EQ(wrench.values[7], reached.torque_B.z());
  EXPECT_LT(reached.torque_B.z(), 1.0);
  EXPECT_NEAR(bench.follower.value().lateral_error_m, 0.3, 1e-12);
  EXPECT_NEAR(bench.follower.value().heading_error_rad, 0.1, 1e-12);
  EXPECT_EQ(bench.follower.value().distance_m, 4.0);
  EXPECT_EQ(bench.follower.value().remaining_m, 5.0);
  bench.ports.write_off(Time{});
  for (const double speed : bench.actuators.value().values) EXPECT_EQ(speed, 0.0);
}

TEST(FlightPorts, RefusesVehiclesWithoutRotors) {
  VehicleDescription rover;
  rover.type = "diff_drive_rover";
  rover.mass_kg = 300.0;
  rover.wheeled.emplace();
  try {
    Bench bench(rover);
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "drone.controller (test) needs a vehicle with rotors; vehicle type "
                 "'diff_drive_rover' has wheels");
  }
}

}  // namespace
}  // namespace vinerow::controllers::flight_ports_test
