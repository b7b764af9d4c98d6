/// Launch by hand, catapult and in the air; faults, battery, parameters.

#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "engine/core/error.h"
#include "tests/support/paths.h"
#include "tests/vehicles/fixed_wing/rig.h"

namespace vinerow::vehicles::launch_test {
namespace {

using namespace test;
using Eigen::Vector3d;

struct EventRecorder {
  explicit EventRecorder(WingRig& rig)
      : event(bus.subscribe<Event>("plane/vehicle_event", "test")) {
    Ports ports(bus, "plane", "plane");
    rig.vehicle.connect(ports);
  }
  SignalBus bus;
  SignalReader<Event> event;
};

TEST(FixedWingLaunch, RestsUntilTheThrottleOpens) {
  WingRig rig;
  const Vector3d start(0, 0, 1.7);
  rig.actuate(0.3, 0.1, -0.1);  // not more than launch_throttle
  rig.run(2.0);
  EXPECT_EQ(rig.body().X_WB.p, start);
  EXPECT_TRUE(rig.vehicle.is_on_launcher());
  EXPECT_NEAR(rig.pitch_rad(), rad_from_deg(22.0), 1e-12);  // elevation and incidence
  EXPECT_NEAR(rig.vehicle.specific_force_B().norm(), kGravity, 1e-12);
  EXPECT_NEAR(rig.vehicle.actuator_states()[1], 0.1, 1e-9);
}

TEST(FixedWingLaunch, IsPushedEvenlyToItsSpeed) {
  for (const double speed : {10.0, 14.0}) {
    FixedWingParams params = plain_params();
    params.launch.mode = LaunchMode::kCatapult;
    params.launch.speed_mps = speed;
    params.launch.length_m = 2.0;
    params.launch.elevation_rad = rad_from_deg(20.0);
    WingRig rig(params, make_flat_world(), 1'000'000, rad_from_deg(30.0));
    EventRecorder recorder(rig);
    rig.actuate(1.0, 0.0, 0.0);
    const Vector3d along(std::cos(rad_from_deg(20.0)) * std::cos(rad_from_deg(30.0)),
                         std::cos(rad_from_deg(20.0)) * std::sin(rad_from_deg(30.0)),
                         std::sin(rad_from_deg(20.0)));
    const double push_s = 2.0 * 2.0 / speed, a = speed / push_s;
    double time_s = 0.0;
    while (rig.vehicle.is_on_launcher()) {
      const Vector3d before = rig.body().X_WB.p, v_before = rig.body().v_WB_W;
      rig.step();
      time_s += 1e-3;
      ASSERT_LT(time_s, 1.0);
      // Velocity and place fit each other and the closed form at every step.
      ASSERT_LT((rig.body().X_WB.p - before - 0.5e-3 * (v_before + rig.body().v_WB_W)).norm(),
                1e-12);
      ASSERT_LT((rig.body().v_WB_W - a * time_s * along).norm(), 0.01 * speed);
      const Vector3d f_W = rig.body().X_WB.q * rig.vehicle.specific_force_B();
      ASSERT_LT((f_W - a * along - Vector3d(0, 0, kGravity)).norm(), 0.01 * a);
    }
    EXPECT_NEAR(rig.body().v_WB_W.norm(), speed, 1e-9);
    EXPECT_LT((rig.body().v_WB_W.normalized() - along).norm(), 1e-9);
    EXPECT_NEAR((rig.body().X_WB.p - Vector3d(0, 0, 1.7)).norm(), 2.0, 0.5e-3 * speed);
    EXPECT_EQ(recorder.event.value().text,
              speed == 10.0 ? "launched at 10.0 m/s" : "launched at 14.0 m/s");
    rig.run(1.0);
    EXPECT_GT(rig.body().X_WB.p.z(), 3.0);  // and climbs on
    EXPECT_EQ(rig.crash(), "");
  }
}

TEST(FixedWingLaunch, FlyingFromTheStartGoesOnLevel) {
  FixedWingParams params = plain_params();
  params.launch.mode = LaunchMode::kAir;
  params.launch.start_height_m = 45.0;
  params.launch.start_speed_mps = 13.0;
  WingRig rig(params, make_flat_world(), 1'000'000, 1.0);
  EXPECT_FALSE(rig.vehicle.is_on_launcher());
  EXPECT_NEAR(rig.body().X_WB.p.z(), 45.0, 1e-12);
  rig.run(5.0);
  EXPECT_NEAR(rig.body().X_WB.p.z(), 45.0, 1e-3);
  EXPECT_NEAR(rig.body().v_WB_W.norm(), 13.0, 1e-4);
  EXPECT_NEAR(std::atan2(rig.body().X_WB.p.y(), rig.body().X_WB.p.x()), 1.0, 1e-6);
}

TEST(FixedWingLaunch, FlyingFromTheStartCountsTheMeanWind) {
  FixedWingParams params = plain_params();
  params.launch.mode = LaunchMode::kAir;
  WorldModel world = make_flat_world();
  world.wind.mean_speed_mps = 5.0;  // from the north
  world.wind.height_law = WindHeightLaw::kUniform;
  WingRig rig(params, std::move(world));
  rig.run(3.0);
  EXPECT_NEAR(rig.vehicle.air_velocity_B().norm(), 12.0, 1e-4);
  EXPECT_NEAR(rig.body().X_WB.p.y(), -15.0, 1e-2);
  EXPECT_NEAR(rig.body().X_WB.p.z(), 60.0, 1e-2);
}

TEST(FixedWingLaunch, StartsNoseUpWhenTold) {
  FixedWingParams params = plain_params();
  params.launch.mode = LaunchMode::kAir;
  params.launch.start_pitch_rad = rad_from_deg(12.0);
  WingRig rig(params);
  EXPECT_NEAR(rig.pitch_rad(), rad_from_deg(12.0), 1e-12);
  rig.run(0.5);
  EXPECT_GT(rig.body().v_WB_W.z(), 0.05);
}

TEST(FixedWingLaunch, RefusesAStartBelowStall) {
  FixedWingParams params = plain_params();
  params.launch.mode = LaunchMode::kAir;
  params.launch.start_speed_mps = 7.0;
  try {
    WingRig rig(params);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "plane: start_speed_mps = 7 allows no level flight: it stalls below 8.4 m/s, or "
                 "throttle or elevons do not suffice");
  }
}

/// In flight at 12 m/s with the reference's trim.
struct Flying : WingRig {
  explicit Flying(const FixedWingParams& the_params) : WingRig(the_params) {
    const PageTrim trim;
    fly(level(80.0, 12.0, trim.alpha_rad), {trim.throttle, trim.elevator_rad, trim.elevator_rad});
  }
};

TEST(FixedWingFaults, MotorStopsAtItsTime) {
  FixedWingParams params = plain_params();
  params.faults.push_back({FixedWingFault::Kind::kMotorFailure, 0.5});
  Flying rig(params);
  EventRecorder recorder(rig);
  rig.run(0.5);
  EXPECT_NEAR(rig.vehicle.actuator_states()[0], 0.5828, 1e-9);
  rig.run(0.2);
  EXPECT_NEAR(rig.vehicle.actuator_states()[0], 0.5828 * std::exp(-2.0), 1e-9);  // lag 0.1 s
  EXPECT_EQ(recorder.event.value().text, "the motor fails");
}

TEST(FixedWingFaults, ElevonSticksWhereItStands) {
  FixedWingParams params = plain_params();
  params.faults.push_back({FixedWingFault::Kind::kElevonStuck, 0.02, false});
  Flying rig(params);
  EventRecorder recorder(rig);
  rig.actuate(0.5828, 0.2, 0.2);
  rig.run(0.3);
  const double left = rad_from_deg(-0.83), stuck = 0.2 + (left - 0.2) * std::exp(-0.5);
  EXPECT_NEAR(rig.vehicle.actuator_states()[1], 0.2, 1e-3);
  EXPECT_NEAR(rig.vehicle.actuator_states()[2], stuck, 1e-9);
  EXPECT_EQ(recorder.event.value().text, "the right elevon is stuck at 4.0 deg");
}

TEST(FixedWingFaults, BatteryRunsEmptyAndStopsTheMotor) {
  FixedWingParams params = plain_params();
  params.battery.initial_charge = 1e-3;  // 80 J: two seconds at 40 W
  Flying rig(params);
  EventRecorder recorder(rig);
  rig.run(0.01);
  // T (k d + V) / 2 over the efficiency of a half, and the electronics.
  const double thrust = 0.0192325 * (std::pow(25.0 * 0.5828, 2) - 144.0);
  EXPECT_NEAR(rig.vehicle.battery().power_W, thrust * (25.0 * 0.5828 + 12.0) + 6.0, 0.05);
  rig.run(2.5);
  EXPECT_EQ(rig.vehicle.battery().charge, 0.0);
  EXPECT_EQ(recorder.event.value().text, "battery empty: the motor stops");
  EXPECT_LT(rig.vehicle.actuator_states()[0], 0.2);
}

TEST(FixedWingServos, AreAsFastAsTheirRate) {
  FixedWingParams params = plain_params();
  params.elevon_rate_radps = 2.0;
  Flying rig(params);
  rig.actuate(0.5828, 0.4, 0.4);
  rig.run(0.1);
  EXPECT_NEAR(rig.vehicle.actuator_states()[1], rad_from_deg(-0.83) + 0.2, 1e-9);
}

std::string refusal(const std::function<void(ParameterSet&)>& spoil) {
  ParameterSet set(fixed_wing_spec().parameters, "fixed_wing");
  try {
    spoil(set);
    read_fixed_wing_params(set, "plane", kGravity);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(FixedWingParameters, DefaultsAreThoseOfTheStruct) {
  const FixedWingParams read =
      read_fixed_wing_params(ParameterSet(fixed_wing_spec().parameters), "plane", kGravity);
  const FixedWingParams own = plain_params();
  EXPECT_NEAR(read.stall_speed_mps(kGravity), 8.4, 0.05);
  EXPECT_EQ(read.inertia_B(), own.inertia_B());
  EXPECT_EQ(read.wing.roll_aileron, own.wing.roll_aileron);
  EXPECT_NEAR(read.wing.stall_angle_rad, own.wing.stall_angle_rad, 1e-15);
  EXPECT_NEAR(read.launch.incidence_rad, own.launch.incidence_rad, 1e-15);
  EXPECT_EQ(read.battery.capacity_Wh, own.battery.capacity_Wh);
}

/// Every number of the shipped file is a parameter, in its range, and the default.
TEST(FixedWingParameters, DefaultsAreThoseOfTheFile) {
  std::ifstream file(std::string(VINEROW_SOURCE_DIR) + "/assets/vehicles/mh900_like.yaml");
  ParameterSet set(fixed_wing_spec().parameters, "fixed_wing");
  const ParameterSet defaults = set;
  const std::regex pattern(R"(^(\w+): \{value: ([-0-9.e]+), source: ".+"\}$)");
  int numbers = 0;
  for (std::string line; std::getline(file, line);) {
    std::smatch found;
    if (!std::regex_match(line, found, pattern)) continue;
    ++numbers;
    set.set(found[1].str(), std::stod(found[2]));
    EXPECT_NEAR(set.number(found[1].str()), defaults.number(found[1].str()), 1e-12) << line;
  }
  EXPECT_EQ(numbers, 63);
}

TEST(FixedWingParameters, RefusesAnElevonOfOtherFaults) {
  const auto with_fault = [](const std::string& kind) {
    return refusal([&](ParameterSet& s) {
      ParameterSet fault = s.make_group("faults");
      fault.set("kind", kind).set("at_s", 5.0).set("elevon", std::string("left"));
      s.set("faults", std::vector<ParameterSet>{fault});
    });
  };
  EXPECT_EQ(with_fault("motor_failure"), "plane: faults[0]: 'elevon' is a key of elevon_stuck");
  EXPECT_EQ(with_fault("elevon_stuck"), "");
}

TEST(FixedWingParameters, RefusesWhatDoesNotFly) {
  EXPECT_EQ(refusal([](ParameterSet& s) { s.set("cruise_speed_mps", 8.0); }),
            "plane: cruise_speed_mps = 8, but it stalls below 8.4 m/s");
  EXPECT_EQ(refusal([](ParameterSet& s) { s.set("wing_area_m2", 0.104); }),
            "plane: cruise_speed_mps = 12, but it stalls below 13.6 m/s");
  EXPECT_EQ(refusal([](ParameterSet& s) {
              s.set("inertia_kgm2", std::vector<double>{0.031, 0.019, 0.060});
            }),
            "plane: inertia_kgm2 = [0.031, 0.019, 0.06] is not possible for a rigid body: one "
            "moment is larger than the sum of the other two");
  EXPECT_EQ(refusal([](ParameterSet& s) { s.set("inertia_xz_kgm2", 0.05); }),
            "plane: inertia_xz_kgm2 = 0.05, must be less than sqrt(Jx Jz) = 0.03857 either side");
  // 0.0395 -+ sqrt(0.0085^2 + 0.02^2), and 0.019 about y.
  EXPECT_EQ(refusal([](ParameterSet& s) { s.set("inertia_xz_kgm2", 0.02); }),
            "plane: inertia_xz_kgm2 = 0.02: the principal inertia = [0.01777, 0.019, 0.06123] is "
            "not possible for a rigid body: one moment is larger than the sum of the other two");
  EXPECT_EQ(refusal([](ParameterSet& s) { s.set("wing_span_m", -1.0); }),
            "wing_span_m = -1 m, must be > 0 m");
}

}  // namespace
}  // namespace vinerow::vehicles::launch_test
