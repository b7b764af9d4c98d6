#include "controllers/parts/ground_drive/differential_drive.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "tests/controllers/support/mission.h"

namespace vinerow::controllers::differential_drive_test {
namespace {

TEST(DifferentialDrive, TurnsLeftByFasterRightWheels) {
  const DifferentialDrive drive(test::make_rover_description(), "test");
  NamedValues actuators = drive.make_actuators();
  drive.mix({1.0, 0.5}, actuators);
  // Rims at 1 -+ 0.5 * 1 m / 2, wheels of 0.2 m; order fl, fr, rl, rr.
  EXPECT_EQ(actuators.names[1], "wheel_fr_speed_radps");
  EXPECT_DOUBLE_EQ(actuators.values[0], 0.75 / 0.2);
  EXPECT_DOUBLE_EQ(actuators.values[1], 1.25 / 0.2);
  EXPECT_DOUBLE_EQ(actuators.values[2], 0.75 / 0.2);
  EXPECT_DOUBLE_EQ(actuators.values[3], 1.25 / 0.2);
}

TEST(DifferentialDrive, LimitKeepsTheCurvature) {
  VehicleDescription description = test::make_rover_description();
  for (ActuatorSpec& actuator : description.actuators) {
    actuator.min = -5.0;
    actuator.max = 5.0;
  }
  const DifferentialDrive drive(description, "test");
  const VelocityCommand limited = drive.limit({1.5, 1.0});  // outer rim 2 m/s, allowed 1 m/s
  EXPECT_DOUBLE_EQ(limited.v_mps, 0.75);
  EXPECT_DOUBLE_EQ(limited.yaw_rate_radps, 0.5);
  EXPECT_DOUBLE_EQ(drive.limit({0.5, 0.2}).v_mps, 0.5);
}

TEST(DifferentialDrive, KnowsSidesByName) {
  for (const char* name : {"wheel_fl_speed_radps", "wheel_left_speed_radps",
                           "wheel_rear_left_speed_radps", "wheel_l_speed_radps"}) {
    EXPECT_EQ(side_of_wheel(name), -1.0) << name;
  }
  for (const char* name : {"wheel_rr_speed_radps", "wheel_right_speed_radps"}) {
    EXPECT_EQ(side_of_wheel(name), 1.0) << name;
  }
  for (const char* name : {"rotor_1_speed_radps", "wheel__speed_radps", "wheel_fl_steer_rad",
                           "wheel_speed_radps", "wheel_front_speed_radps"}) {
    EXPECT_EQ(side_of_wheel(name), 0.0) << name;
  }
}

TEST(DifferentialDrive, RefusesOtherVehicles) {
  VehicleDescription description;
  description.type = "quadrotor";
  description.actuators = {{"rotor_1_speed_radps", "rad/s", 0, 900}};
  try {
    DifferentialDrive drive(description, "rover.controller (pure_pursuit)");
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(
        error.what(),
        "rover.controller (pure_pursuit) steers by the speeds of left and right wheels "
        "(wheel_fl_speed_radps, wheel_right_speed_radps, ...), but vehicle type 'quadrotor' "
        "has the actuators rotor_1_speed_radps");
  }
}

}  // namespace
}  // namespace vinerow::controllers::differential_drive_test
