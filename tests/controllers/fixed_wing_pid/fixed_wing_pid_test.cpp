// The autopilot beside what every controller of vehicles on wings keeps
// (aircraft_conformance_test.cpp).

#include <gtest/gtest.h>

#include <cmath>

#include "controllers/fixed_wing_pid/fixed_wing_pid_law.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/aircraft_loop.h"

namespace vinerow::test::fixed_wing_pid_test {
namespace {

TEST(FixedWingPid, LearnsWhatItIsNotToldOf) {
  // The plane is heavier, crooked and has a weaker propeller than stated: no error remains.
  AircraftSetup setup;
  setup.controller.type = "fixed_wing_pid";
  setup.assumed = setup.numbers;
  setup.numbers.mass_kg *= 1.08;
  setup.numbers.Cm0 += 0.004;
  setup.numbers.motor_mps *= 0.97;
  setup.reference = fly_straight(0.3, 100.0);
  AircraftLoop loop(setup);
  double worst_m = 0.0;
  loop.run_until(60.0, [&] { worst_m = std::max(worst_m, std::abs(loop.deviation("h_m"))); });
  EXPECT_LT(worst_m, 4.0);
  EXPECT_LT(std::abs(loop.deviation("h_m")), 0.1);
  EXPECT_LT(std::abs(loop.deviation("u_mps")), 0.1);
  EXPECT_LT(std::abs(loop.deviation("psi_rad")), 1e-6);
}

TEST(FixedWingPid, DoesNotPullIntoTheStall) {
  // Ramps that no aircraft follows: from 8 deg down to 12 deg up at once, in a turn.
  AircraftSetup setup;
  setup.controller.type = "fixed_wing_pid";
  setup.reference = [](double time_s) {
    AirReference at = fly_circle(0.0, 100.0, 0.6)(time_s);
    at.climb_angle_rad = rad_from_deg(time_s < 4.0 ? -8.0 : 12.0);
    at.height_m = 100.0 + 12.0 * std::sin(rad_from_deg(-8.0)) * std::min(time_s, 4.0) +
                  12.0 * std::sin(rad_from_deg(12.0)) * std::max(time_s - 4.0, 0.0);
    return at;
  };
  AircraftLoop loop(setup);
  double incidence_rad = 0.0, height_m = 0.0;
  loop.run_until(15.0, [&] {
    const Eigen::Vector3d air = loop.sim().air_velocity();
    incidence_rad = std::max(incidence_rad, std::atan2(air.z(), air.x()));
    height_m = std::max(height_m, std::abs(loop.deviation("h_m")));
  });
  EXPECT_LT(deg_from_rad(incidence_rad), 20.6);  // where the lift falls off
  EXPECT_LT(height_m, 5.0);
  EXPECT_LT(std::abs(loop.deviation("h_m")), 0.5);
}

TEST(FixedWingPidLaw, DampsAndCorrectsWithTheRightSigns) {
  controllers::FixedWingPidLaw law({}, 12.0, 0.05);
  controllers::AircraftDeviation x;
  x.lon(4) = 1.0;  // too high: elevator down
  EXPECT_GT(law.step(x, 0.0).elevator_rad, 0.0);
  EXPECT_GT(law.step({}, 0.5).elevator_rad, 0.0);  // climbs too fast
  x = {};
  x.lon(2) = 0.1;
  EXPECT_GT(law.step(x, 0.0).elevator_rad, 0.0);
  x = {};
  x.lon(0) = 1.0;
  EXPECT_LT(law.step(x, 0.0).throttle, 0.0);
  for (const int i : {1, 2, 3, 4}) {  // rolls, yaws, banks, heads to the right: aileron to the left
    x = {};
    x.lat(i) = 0.1;
    EXPECT_LT(law.step(x, 0.0).aileron_rad, 0.0) << i;
  }
}

TEST(FixedWingPidLaw, DoesNotWindUpAtAStop) {
  // Ten seconds of full throttle that is not enough leave nothing behind.
  controllers::FixedWingPidLaw law({}, 12.0, 0.05);
  controllers::AircraftDeviation slow;
  slow.lon(0) = -8.0;
  for (int i = 0; i < 200; ++i) {
    const controllers::AircraftControls requested = law.step(slow, 0.0);
    controllers::AircraftControls left = requested;
    left.throttle = 0.4;
    law.learn(requested, left);
  }
  EXPECT_EQ(law.step({}, 0.0).throttle, 0.0);
  // Where the actuator follows, it learns.
  const controllers::AircraftControls requested = law.step(slow, 0.0);
  law.learn(requested, requested);
  EXPECT_NEAR(law.step({}, 0.0).throttle, 0.02 * 0.05 * 8.0, 1e-12);
}

}  // namespace
}  // namespace vinerow::test::fixed_wing_pid_test
