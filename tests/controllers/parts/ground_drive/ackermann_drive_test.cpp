#include "controllers/parts/ground_drive/ackermann_drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/core/error.h"

namespace vinerow::controllers::ackermann_drive_test {
namespace {

/// Wheel base 2 m, track 1.2 m, B 0.8 m ahead of the rear axle, wheels of 0.4 m.
VehicleDescription make_car() {
  VehicleDescription car;
  car.type = "car";
  car.actuators.push_back({"axle_front_steer_rad", "rad", -0.5, 0.5});
  for (const char* place : {"fl", "fr", "rl", "rr"}) {
    car.actuators.push_back({std::string("wheel_") + place + "_speed_radps", "rad/s", -10.0, 10.0});
  }
  car.wheeled = {
      .track_m = 1.2, .wheel_base_m = 2.0, .wheel_radius_m = 0.4, .wheel_speed_limit_radps = 10.0};
  car.ackermann = {.rear_axle_m = 0.8, .max_axle_steer_rad = 0.5, .steer_rate_radps = 1.0};
  return car;
}

/// Speed of the body over the ground at a point in B, from rigid body kinematics: v_x and w of B,
/// and no sideways speed on the rear axle.
double ground_speed_mps(const VelocityCommand& command, double x_m, double y_m) {
  const double vy_mps = 0.8 * command.yaw_rate_radps;
  return std::hypot(command.v_mps - command.yaw_rate_radps * y_m,
                    vy_mps + command.yaw_rate_radps * x_m);
}

TEST(AckermannDrive, WheelsRollWithoutSliding) {
  const AckermannDrive drive(make_car(), "test");
  NamedValues values = drive.make_actuators();
  for (const VelocityCommand command : {VelocityCommand{1.5, 0.3}, VelocityCommand{0.7, -0.1}}) {
    drive.mix(command, values);
    // The front wheel in the middle points along the velocity there.
    EXPECT_NEAR(values.values[0], std::atan2(2.0 * command.yaw_rate_radps, command.v_mps), 1e-12);
    const double x[] = {1.2, 1.2, -0.8, -0.8}, y[] = {0.6, -0.6, 0.6, -0.6};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(0.4 * values.values[1 + i], ground_speed_mps(command, x[i], y[i]), 1e-12) << i;
    }
  }
  drive.mix({-1.0, 0.2}, values);  // backwards to the left: the front wheels point right
  EXPECT_NEAR(values.values[0], -std::atan(0.4), 1e-12);
  EXPECT_LT(values.values[3], 0.0);
}

TEST(AckermannDrive, KeepsTheAngleWhereItStands) {
  const AckermannDrive drive(make_car(), "test");
  NamedValues values = drive.make_actuators();
  drive.mix({1.0, 0.1}, values);
  const double angle_rad = values.values[0];
  drive.mix({0.0, 1.0}, values);
  EXPECT_EQ(values.values, (std::vector<double>{angle_rad, 0.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(drive.limit({0.0, 1.0}).yaw_rate_radps, 0.0);
  EXPECT_FALSE(drive.turns_on_the_spot());
}

TEST(AckermannDrive, LimitsTheCurvatureThenTheSpeed) {
  const AckermannDrive drive(make_car(), "test");
  const VelocityCommand tight = drive.limit({1.0, 5.0});
  EXPECT_NEAR(tight.yaw_rate_radps, std::tan(0.5) / 2.0, 1e-12);
  EXPECT_EQ(tight.v_mps, 1.0);
  const VelocityCommand fast = drive.limit({4.0, 0.8});  // rims of 4 m/s at most
  const double x = 1.2, y = -0.6;                        // the outer front wheel is the fastest
  EXPECT_NEAR(ground_speed_mps(fast, x, y), 4.0, 1e-12);
  EXPECT_NEAR(fast.yaw_rate_radps / fast.v_mps, 0.2, 1e-12);
}

TEST(AckermannDrive, RefusesOtherActuators) {
  VehicleDescription car = make_car();
  car.actuators.back().name = "wheel_5_speed_radps";
  try {
    AckermannDrive drive(car, "a.controller (pure_pursuit)");
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "a.controller (pure_pursuit) steers by a front axle and drives wheels fl, fr, rl, "
                 "rr (axle_front_steer_rad, wheel_rl_speed_radps, ...), but vehicle type 'car' has "
                 "the actuators axle_front_steer_rad, wheel_fl_speed_radps, wheel_fr_speed_radps, "
                 "wheel_rl_speed_radps, wheel_5_speed_radps");
  }
}

}  // namespace
}  // namespace vinerow::controllers::ackermann_drive_test
