/// The mechanism, its limits and its servos.

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "tests/vehicles/four_wheel_steering_rover/rig.h"
#include "vehicles/parts/double_ackermann.h"

namespace vinerow::vehicles::steering_test {
namespace {

using namespace test;

struct Case {
  double front_deg, rear_deg;
  std::array<double, 4> wheels_deg;
};

/// Computed apart from this program, a = b = 0.75 m, track 0.85 m, to two decimals.
const std::vector<Case> kOracle = {
    {0, 0, {0, 0, 0, 0}},
    {10, 10, {10, 10, 10, 10}},
    {10, -10, {11.08, 9.11, -11.08, -9.11}},
    {-10, 10, {-9.11, -11.08, 9.11, 11.08}},
    {23, -23, {29.20, 18.89, -29.20, -18.89}},
    {15, 0, {16.17, 13.98, 0, 0}},
    {0, -12, {0, 0, -12.74, -11.34}},
    {18, 5, {19.21, 16.93, 5.36, 4.69}},
    {5, 18, {4.69, 5.36, 16.93, 19.21}},
    {12, -8, {13.29, 10.94, -8.88, -7.28}},
    {10, 9.99, {10, 10, 9.99, 9.99}},
};

TEST(DoubleAckermann, WheelAnglesOfTheOracle) {
  for (const Case& row : kOracle) {
    const auto angles =
        calc_wheel_angles({}, rad_from_deg(row.front_deg), rad_from_deg(row.rear_deg));
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(deg_from_rad(angles[i]), row.wheels_deg[i], 0.01)
          << row.front_deg << "/" << row.rear_deg << ", wheel " << i;
    }
  }
}

TEST(DoubleAckermann, AllAxlesOfRotationMeetInOnePoint) {
  const TwoAxles axles{0.9, 0.5, 1.1};  // not symmetric: a and b must not be mixed up
  for (const double front_deg : {-20.0, -3.0, 7.0, 22.0}) {
    for (const double rear_deg : {-22.0, -1.0, 5.0, 18.0}) {
      const double front = rad_from_deg(front_deg), rear = rad_from_deg(rear_deg);
      const auto angles = calc_wheel_angles(axles, front, rear);
      // The centre: where the normals of both axles' bicycle wheels cross.
      const Eigen::Vector2d n_f(-std::sin(front), std::cos(front));
      const Eigen::Vector2d n_r(-std::sin(rear), std::cos(rear));
      Eigen::Matrix2d normals;
      normals << n_f, -n_r;
      const Eigen::Vector2d lengths =
          normals.partialPivLu().solve(Eigen::Vector2d(-axles.rear_m - axles.front_m, 0.0));
      const Eigen::Vector2d centre = Eigen::Vector2d(axles.front_m, 0.0) + lengths[0] * n_f;
      for (std::size_t i = 0; i < 4; ++i) {
        const Eigen::Vector2d wheel(kCorners[i].along > 0 ? axles.front_m : -axles.rear_m,
                                    0.5 * kCorners[i].across * axles.track_m);
        const Eigen::Vector2d heading(std::cos(angles[i]), std::sin(angles[i]));
        EXPECT_NEAR(heading.dot((centre - wheel).normalized()), 0.0, 1e-9)
            << front_deg << "/" << rear_deg << ", wheel " << i;
      }
    }
  }
}

TEST(FourWheelSteeringRover, TheMechanismTurnsItsWheelsToTheOraclesAngles) {
  FourWheelRig rig(make_flat_world());
  for (const Case& row : kOracle) {
    rig.actuate(row.front_deg, row.rear_deg, {});
    rig.run(1.5);  // servos settle: 30 time constants
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(deg_from_rad(rig.wheel(i).steer_rad), row.wheels_deg[i], 0.01);
    }
    EXPECT_NEAR(deg_from_rad(rig.vehicle.actuator_states()[0]), row.front_deg, 1e-6);
    EXPECT_NEAR(deg_from_rad(rig.vehicle.actuator_states()[1]), row.rear_deg, 1e-6);
  }
}

TEST(FourWheelSteeringRover, TellsBothReadingsOfTheSteeringRange) {
  FourWheelSteeringRoverParams params;
  const FourWheelSteeringRover as_axle(params);
  const VehicleDescription& about = as_axle.description();
  EXPECT_NEAR(about.min_turning_radius_m.value(), 1.767, 5e-4);
  EXPECT_NEAR(deg_from_rad(about.steered->max_axle_steer_rad), 23.0, 1e-9);
  EXPECT_DOUBLE_EQ(about.max_speed_mps.value(), 1.6);
  EXPECT_DOUBLE_EQ(about.steered->front_axle_m, 0.75);
  EXPECT_DOUBLE_EQ(about.steered->rear_axle_m, 0.75);
  ASSERT_EQ(about.actuators.size(), 6u);
  const char* names[] = {"axle_front_steer_rad", "axle_rear_steer_rad",  "wheel_fl_speed_radps",
                         "wheel_fr_speed_radps", "wheel_rl_speed_radps", "wheel_rr_speed_radps"};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(about.actuators[i].name, names[i]);
  EXPECT_NEAR(about.actuators[0].max, rad_from_deg(23.0), 1e-12);
  EXPECT_EQ(about.actuators[2].max, 8.0);

  params.limits_wheels = true;
  const FourWheelSteeringRover as_wheel(params);
  EXPECT_NEAR(as_wheel.description().min_turning_radius_m.value(), 2.19, 5e-3);
  EXPECT_NEAR(deg_from_rad(as_wheel.description().actuators[0].max), 18.9, 0.05);
  // No pair of axle angles inside that limit turns a wheel beyond 23 deg.
  const double max_rad = params.max_axle_steer_rad();
  double largest = 0.0;
  for (int i = -20; i <= 20; ++i) {
    for (int j = -20; j <= 20; ++j) {
      for (const double angle :
           calc_wheel_angles(params.axles(), i * max_rad / 20, j * max_rad / 20)) {
        largest = std::max(largest, std::abs(angle));
      }
    }
  }
  EXPECT_NEAR(deg_from_rad(largest), 23.0, 1e-9);
}

TEST(FourWheelSteeringRover, FootprintIsAConvexOctagonInsideTheHullsBox) {
  const FourWheelSteeringRover rover{FourWheelSteeringRoverParams{}};
  const std::vector<Eigen::Vector2d>& outline = rover.description().footprint_B;
  ASSERT_EQ(outline.size(), 8u);
  const Eigen::Vector2d corners[] = {{0.95, -0.36}, {0.95, 0.36},   {0.75, 0.5},   {-0.75, 0.5},
                                     {-0.95, 0.36}, {-0.95, -0.36}, {-0.75, -0.5}, {0.75, -0.5}};
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR((outline[i] - corners[i]).norm(), 0.0, 1e-12) << i;
    const Eigen::Vector2d along = outline[(i + 1) % 8] - outline[i];
    const Eigen::Vector2d next = outline[(i + 2) % 8] - outline[(i + 1) % 8];
    EXPECT_GT(along.x() * next.y() - along.y() * next.x(), 0.0) << i;  // counter-clockwise
  }
}

TEST(FourWheelSteeringRover, ServosKeepTheirRateLimitAndLag) {
  FourWheelRig rig(make_flat_world());
  rig.run(0.2);
  rig.actuate(23.0, -23.0, {});
  const double target = rad_from_deg(23.0), rate = 2.0, lag = 0.05;
  // Closed form: a ramp until the error is rate * lag, then an exponential.
  const double ramp_s = (target - rate * lag) / rate;
  double last = 0.0;
  std::array<double, 4> last_wheels{};
  for (int i = 1; i <= 400; ++i) {
    rig.step();
    const double t = 0.001 * i, angle = rig.vehicle.actuator_states()[0];
    const double expected =
        t < ramp_s ? rate * t : target - rate * lag * std::exp(-(t - ramp_s) / lag);
    EXPECT_NEAR(angle, expected, 2e-4) << t;  // one step astride the change: rate dt / 10
    EXPECT_LE(angle - last, rate * 0.001 * (1.0 + 1e-9)) << t;
    EXPECT_DOUBLE_EQ(rig.vehicle.actuator_states()[1], -angle);
    // The inner wheel turns d(wheel)/d(axle) as fast as the axle: with t = tan(axle) and
    // f = t / (1 - t B / L), (1 + t^2) / (1 + f^2) / (1 - t B / L)^2, at the ramp's end 1.415.
    for (std::size_t w = 0; w < 4; ++w) {
      EXPECT_LE(std::abs(rig.wheel(w).steer_rad - last_wheels[w]), 1.416 * rate * 0.001);
      last_wheels[w] = rig.wheel(w).steer_rad;
    }
    last = angle;
  }
  EXPECT_NEAR(last, target, 1e-3);
}

TEST(SteeringServo, NeverOvershootsAtAnyStep) {
  for (const double dt_s : {1e-4, 1e-3, 0.02, 0.5}) {
    for (const double lag_s : {0.0, 0.05, 1.0}) {
      double angle = -0.3;
      for (int i = 0; i < 100; ++i) {
        const double next = advance_servo({2.0, lag_s}, 0.3, dt_s, angle);
        EXPECT_GE(next, angle);
        EXPECT_LE(next, 0.3);
        angle = next;
      }
    }
  }
}

TEST(FourWheelSteeringRover, KnucklesSteerAndWheelsRollToo) {
  FourWheelRig rig(make_flat_world());
  rig.actuate(20.0, -20.0, {2, 2, 2, 2});
  rig.run(0.6);
  std::vector<Pose> poses(rig.vehicle.links().size());
  rig.vehicle.read_links(poses);
  ASSERT_EQ(poses.size(), 9u);
  EXPECT_EQ(rig.vehicle.links()[1].name, "wheel_fl");
  EXPECT_EQ(rig.vehicle.links()[5].name, "knuckle_fl");
  const Eigen::Quaterniond q_BW = poses[0].q.conjugate();
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d knuckle_x = q_BW * poses[5 + i].q * Eigen::Vector3d::UnitX();
    EXPECT_NEAR(std::atan2(knuckle_x.y(), knuckle_x.x()), rig.wheel(i).steer_rad, 1e-12);
    EXPECT_NEAR(knuckle_x.z(), 0.0, 1e-12);
    EXPECT_NEAR((poses[5 + i].p - poses[1 + i].p).norm(), 0.0, 1e-12);
    const Eigen::Vector3d wheel_x = q_BW * poses[1 + i].q * Eigen::Vector3d::UnitX();
    EXPECT_LT(wheel_x.z(), -0.5);  // about 1.1 rad forward
  }
}

TEST(FourWheelSteeringRoverParams, RejectsBadNumbersByName) {
  FourWheelSteeringRoverParams params;
  params.name = "rover";
  params.max_steer_rad = 0.0;
  const auto message = [&] {
    try {
      params.validate();
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message(), "rover: max_steer_deg = 0 deg, must be >= 1 deg and <= 45 deg");
  params.max_steer_rad = rad_from_deg(45.0);
  params.track_m = 1.6;
  EXPECT_EQ(message(),
            "rover: max_steer_deg = 45 puts the centre of the tightest turn 0.75 m beside the "
            "centre of mass, under the wheels of track_m = 1.6");
  params.track_m = 0.85;
  params.servo.rate_radps = 0.0;
  EXPECT_EQ(message(), "rover: steer_rate_radps = 0 rad/s, must be > 0 rad/s");
  params.servo.rate_radps = 2.0;
  params.mass_kg = -1.0;
  EXPECT_EQ(message(), "rover: mass_kg = -1 kg, must be > 0 kg");
}

}  // namespace
}  // namespace vinerow::vehicles::steering_test
