// From outputs of an autopilot to actuators: signs and shares by closed form, and channel lists
// with mistakes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "controllers/autopilot/outputs/output_channels.h"
#include "engine/api/vehicle.h"
#include "engine/core/error.h"
#include "tests/controllers/support/plant.h"

namespace vinerow::controllers::output_map_test {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using Pulses = std::vector<std::uint16_t>;

constexpr const char* kWho = "rover.autopilot (ardupilot)";

NamedValues driven(const VehicleDescription& vehicle, const Pulses& pulses,
                   const std::string& mixer = "", std::vector<OutputChannel> channels = {}) {
  OutputMap map(vehicle, mixer, std::move(channels), 16, kWho);
  NamedValues actuators = map.make_actuators();
  map.apply_pulses(pulses, actuators);
  return actuators;
}

double value_of(const NamedValues& actuators, const std::string& name) {
  for (std::size_t i = 0; i < actuators.names.size(); ++i) {
    if (actuators.names[i] == name) return actuators.values[i];
  }
  ADD_FAILURE() << "no actuator " << name;
  return 0.0;
}

/// Paper B's rover with wheels of at most 8 rad/s.
VehicleDescription rover() {
  VehicleDescription description = test::make_rover_description();
  for (ActuatorSpec& actuator : description.actuators) actuator.min = -8.0, actuator.max = 8.0;
  return description;
}

/// @param torque_sign  of the rotor front right; Vinerow's quadrotor has +1
VehicleDescription quadrotor(double torque_sign) {
  VehicleDescription description;
  description.type = "quadrotor";
  Rotorcraft craft;
  const Eigen::Vector2d places[] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  for (int i = 0; i < 4; ++i) {
    description.actuators.push_back(
        {"rotor_" + std::to_string(i + 1) + "_speed_radps", "rad/s", 0.0, 1000.0});
    craft.rotors.push_back({places[i], (i % 2 == 0 ? -1.0 : 1.0) * torque_sign});
  }
  description.rotorcraft = craft;
  return description;
}

VehicleDescription wing() {
  VehicleDescription description;
  description.type = "fixed_wing";
  description.actuators = {{"throttle", "", 0.0, 1.0},
                           {"elevon_left_rad", "rad", -0.5, 0.5},
                           {"elevon_right_rad", "rad", -0.5, 0.5}};
  description.fixed_wing = FixedWingAircraft{};
  return description;
}

TEST(OutputMap, SkidDrivesTheSides) {
  // Full ahead on the left, half back on the right; SERVO2 does not count.
  const NamedValues actuators = driven(rover(), {2000, 2000, 1250, 0});
  for (const std::string place : {"fl", "rl"}) {
    EXPECT_DOUBLE_EQ(value_of(actuators, "wheel_" + place + "_speed_radps"), 8.0);
  }
  for (const std::string place : {"fr", "rr"}) {
    EXPECT_DOUBLE_EQ(value_of(actuators, "wheel_" + place + "_speed_radps"), -4.0);
  }
}

TEST(OutputMap, ThrottleAndSteeringAreMixed) {
  const auto left_right = [](std::uint16_t steering, std::uint16_t throttle) {
    const NamedValues actuators = driven(rover(), {steering, 0, throttle}, "throttle_steering");
    return std::vector<double>{value_of(actuators, "wheel_fl_speed_radps") / 8.0,
                               value_of(actuators, "wheel_fr_speed_radps") / 8.0};
  };
  EXPECT_THAT(left_right(1500, 1750), ElementsAre(0.5, 0.5));
  // Steering is positive to the right: the left wheels are faster.
  EXPECT_THAT(left_right(1625, 1750), ElementsAre(0.75, 0.25));
  // Beyond the limit both shrink, and the curvature stays.
  EXPECT_THAT(left_right(2000, 2000), ElementsAre(1.0, 0.0));
  EXPECT_THAT(left_right(1750, 2000), ElementsAre(1.0, DoubleNear(1.0 / 3.0, 1e-12)));
}

TEST(OutputMap, SteeredWheelsTurnAboutOnePoint) {
  const VehicleDescription steered = test::make_steered_description();
  const SteeredVehicle& axles = *steered.steered;
  const WheeledVehicle& wheels = *steered.wheeled;
  // Front half to the left (pulse below neutral), rear as far to the right: the centre of the turn
  // is to the left, beside the middle between the axles.
  const NamedValues actuators = driven(steered, {1250, 1750, 1750});
  const double limit_rad = axles.max_axle_steer_rad;
  EXPECT_DOUBLE_EQ(value_of(actuators, "axle_front_steer_rad"), 0.5 * limit_rad);
  EXPECT_DOUBLE_EQ(value_of(actuators, "axle_rear_steer_rad"), -0.5 * limit_rad);
  const double base_m = axles.front_axle_m + axles.rear_axle_m;
  const double radius_m = 0.5 * base_m / std::tan(0.5 * limit_rad);
  const auto distance = [&](double y) { return std::hypot(radius_m - y, 0.5 * base_m); };
  const double inner = distance(0.5 * wheels.track_m), outer = distance(-0.5 * wheels.track_m);
  const double max = wheels.wheel_speed_limit_radps;
  for (const std::string place : {"fr", "rr"}) {
    EXPECT_NEAR(value_of(actuators, "wheel_" + place + "_speed_radps"), 0.5 * max, 1e-12) << place;
  }
  for (const std::string place : {"fl", "rl"}) {
    EXPECT_NEAR(value_of(actuators, "wheel_" + place + "_speed_radps"), 0.5 * max * inner / outer,
                1e-12)
        << place;
  }
}

TEST(OutputMap, CrabbingWheelsAreEquallyFast) {
  const NamedValues actuators = driven(test::make_steered_description(), {1250, 1250, 1600});
  EXPECT_DOUBLE_EQ(value_of(actuators, "axle_front_steer_rad"),
                   value_of(actuators, "axle_rear_steer_rad"));
  for (const std::string place : {"fl", "fr", "rl", "rr"}) {
    EXPECT_NEAR(value_of(actuators, "wheel_" + place + "_speed_radps"), 0.2 * 8.0, 1e-12);
  }
}

TEST(OutputMap, MotorsStandWhereTheirSpinSays) {
  // ArduPilot's X (FRAME_TYPE 1): front right and rear left turn counter-clockwise, outputs
  // 1 front right, 2 rear left, 3 front left, 4 rear right.
  const Pulses pulses = {1100, 1200, 1300, 1400};
  EXPECT_THAT(driven(quadrotor(-1.0), pulses).values,
              ElementsAre(DoubleNear(300, 1e-9), DoubleNear(200, 1e-9), DoubleNear(400, 1e-9),
                          DoubleNear(100, 1e-9)))
      << "our rotors 1 front left, 2 rear left, 3 rear right, 4 front right";
}

TEST(OutputMap, ReversedXHasTheOrderOfItsFrameType) {
  // FRAME_TYPE 18: 1 rear right, 2 front right, 3 rear left, 4 front left.
  const Pulses pulses = {1100, 1200, 1300, 1400};
  EXPECT_THAT(driven(quadrotor(1.0), pulses).values,
              ElementsAre(DoubleNear(400, 1e-9), DoubleNear(300, 1e-9), DoubleNear(100, 1e-9),
                          DoubleNear(200, 1e-9)));
}

TEST(OutputMap, ElevonsArePositiveUpwardsInAnAutopilot) {
  const NamedValues actuators = driven(wing(), {1750, 1250, 1600});
  EXPECT_DOUBLE_EQ(value_of(actuators, "elevon_left_rad"), -0.25);
  EXPECT_DOUBLE_EQ(value_of(actuators, "elevon_right_rad"), 0.25);
  EXPECT_DOUBLE_EQ(value_of(actuators, "throttle"), 0.6);
}

TEST(OutputMap, NoPulseIsNeutralOrOff) {
  for (const double value : driven(rover(), {0, 0, 0}).values) EXPECT_EQ(value, 0.0);
  for (const double value : driven(quadrotor(1.0), {0, 0, 0, 0}).values) EXPECT_EQ(value, 0.0);
  for (const double value : driven(wing(), {}).values) EXPECT_EQ(value, 0.0);
}

TEST(OutputMap, ChannelsHaveTheirOwnPulsesAndDirections) {
  OutputChannel left{"left", 5, true, 1100.0, 1500.0, 1900.0}, right{"right", 2};
  Pulses pulses(16, 0);
  pulses[4] = 1700;
  pulses[1] = 2100;  // beyond the longest pulse
  const NamedValues actuators = driven(rover(), pulses, "", {right, left});
  EXPECT_DOUBLE_EQ(value_of(actuators, "wheel_fl_speed_radps"), -4.0);
  EXPECT_DOUBLE_EQ(value_of(actuators, "wheel_fr_speed_radps"), 8.0);
}

TEST(OutputMap, SharesAreTakenAsTheyAre) {
  OutputMap map(quadrotor(1.0), "", {}, 16, kWho);
  NamedValues actuators = map.make_actuators();
  const std::vector<float> shares = {0.25F, std::numeric_limits<float>::quiet_NaN(), 2.0F, -1.0F};
  map.apply_shares(shares, actuators);
  EXPECT_THAT(actuators.values, ElementsAre(0.0, 1000.0, 250.0, 0.0));
}

std::string refusal(const VehicleDescription& vehicle, const std::string& mixer,
                    std::vector<OutputChannel> channels) {
  try {
    OutputMap(vehicle, mixer, std::move(channels), 16, kWho);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(OutputMap, RefusesListsWithMistakes) {
  const std::string who = "rover.autopilot (ardupilot): ";
  EXPECT_EQ(refusal(rover(), "", {{"left", 1}}),
            who + "channels: no output drives 'right'; needed are left, right");
  EXPECT_EQ(refusal(rover(), "", {{"left", 1}, {"left", 2}}),
            who + "channels: 'left' occurs twice");
  EXPECT_EQ(refusal(rover(), "", {{"left", 1}, {"right", 1}}),
            who + "channels: output 1 drives both 'left' and 'right'");
  EXPECT_EQ(refusal(rover(), "", {{"left", 1}, {"right", 17}}),
            who + "channels[1]: the autopilot has no output 17, only 16");
  const std::string unknown = refusal(rover(), "", {{"lef", 1}, {"right", 3}});
  EXPECT_THAT(unknown, ::testing::HasSubstr("has no function 'lef'; did you mean 'left'?"));
}

TEST(OutputMap, RefusesAMixerThatDoesNotFit) {
  EXPECT_THAT(refusal(rover(), "quadrotor_x", {}),
              ::testing::HasSubstr("needs a vehicle with rotors"));
  EXPECT_THAT(refusal(wing(), "skid", {}), ::testing::HasSubstr("needs a vehicle with wheels"));
  EXPECT_THAT(refusal(test::make_steered_description(), "skid", {}),
              ::testing::HasSubstr("'axle_front_steer_rad' of vehicle type"));
  VehicleDescription three = quadrotor(1.0);
  three.rotorcraft->rotors.pop_back();
  EXPECT_THAT(refusal(three, "", {}), ::testing::HasSubstr("needs one rotor in each quarter"));
}

}  // namespace
}  // namespace vinerow::controllers::output_map_test
