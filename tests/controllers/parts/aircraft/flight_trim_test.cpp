// Trims judged by the second implementation of aircraft_sim.h and by the reference of paper A,
// section 1.

#include "controllers/parts/aircraft/flight_trim.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"
#include "tests/controllers/support/aircraft_sim.h"

namespace vinerow::test::flight_trim_test {
namespace {

controllers::Aircraft aircraft_of(const AircraftNumbers& numbers) {
  return controllers::read_aircraft(describe(numbers), numbers.gravity_mps2, "plane.controller");
}

/// What the second implementation makes of it: largest acceleration, m/s2 or rad/s2.
double acceleration_left(const AircraftNumbers& numbers, const controllers::Trim& trim) {
  AircraftSim sim(numbers);
  sim.start({0, 0, 100}, trim.roll_rad, trim.pitch_rad, 0.7, {trim.u_mps, trim.v_mps, trim.w_mps},
            {trim.p_radps, trim.q_radps, trim.r_radps},
            {trim.controls.throttle, trim.controls.elevator_rad, trim.controls.aileron_rad});
  return sim.accelerations().cwiseAbs().maxCoeff();
}

TEST(FlightTrim, LevelFlightIsTheReferences) {
  const AircraftNumbers numbers = make_reference_wing();
  const Result<controllers::Trim> trim =
      controllers::find_trim(aircraft_of(numbers), {12.0, 0.0, 0.0});
  ASSERT_TRUE(trim) << trim.reason();
  EXPECT_NEAR(deg_from_rad(trim->alpha_rad), 7.35, 0.01);
  EXPECT_NEAR(deg_from_rad(trim->pitch_rad), 7.35, 0.01);
  EXPECT_NEAR(trim->controls.throttle, 0.5828, 1e-4);
  EXPECT_NEAR(deg_from_rad(trim->controls.elevator_rad), -0.830, 0.002);
  EXPECT_NEAR(trim->controls.aileron_rad, 0.0, 1e-12);
  EXPECT_NEAR(trim->beta_rad, 0.0, 1e-12);
  EXPECT_LT(trim->residual, 1e-9);
  EXPECT_LT(acceleration_left(numbers, *trim), 1e-9);
  RecordProperty("alpha_deg", std::to_string(deg_from_rad(trim->alpha_rad)));
  RecordProperty("throttle", std::to_string(trim->controls.throttle));
  RecordProperty("elevator_deg", std::to_string(deg_from_rad(trim->controls.elevator_rad)));
}

TEST(FlightTrim, ClimbsAndTurnsHoldInASecondImplementation) {
  const AircraftNumbers numbers = make_mh900_like();
  const controllers::Aircraft aircraft = aircraft_of(numbers);
  int found = 0;
  for (const double speed : {10.5, 12.0, 15.0}) {
    for (const double climb_deg : {-6.0, 0.0, 5.0}) {
      for (const double bank_deg : {-40.0, -15.0, 0.0, 30.0}) {
        const controllers::TrimRequest request{speed, rad_from_deg(climb_deg),
                                               rad_from_deg(bank_deg)};
        const Result<controllers::Trim> trim = controllers::find_trim(aircraft, request);
        if (!trim) continue;
        ++found;
        EXPECT_LT(trim->residual, 1e-9);
        EXPECT_LT(acceleration_left(numbers, *trim), 1e-8);
        EXPECT_NEAR(std::hypot(trim->u_mps, trim->v_mps, trim->w_mps), speed, 1e-9);
        // The path climbs as asked.
        AircraftSim sim(numbers);
        sim.start({0, 0, 0}, trim->roll_rad, trim->pitch_rad, 0.0,
                  {trim->u_mps, trim->v_mps, trim->w_mps},
                  {trim->p_radps, trim->q_radps, trim->r_radps}, Eigen::Vector3d::Zero());
        const Odometry truth = sim.truth();
        EXPECT_NEAR((truth.X_WB.q * truth.v_WB_B).z(), speed * std::sin(request.climb_angle_rad),
                    1e-9);
        // A coordinated turn's rate and nearly its roll and load.
        EXPECT_EQ(trim->turn_rate_radps, 9.80665 * std::tan(request.bank_rad) / speed);
        EXPECT_NEAR(trim->roll_rad, request.bank_rad, rad_from_deg(2.5));
        EXPECT_NEAR(trim->load_factor * std::cos(request.bank_rad), 1.0, 0.05);
        EXPECT_LT(std::abs(trim->beta_rad), rad_from_deg(3.0));
      }
    }
  }
  EXPECT_GE(found, 32);
}

TEST(FlightTrim, LeftAndRightMirrorEachOther) {
  const controllers::Aircraft aircraft = aircraft_of(make_mh900_like());
  const Result<controllers::Trim> right = controllers::find_trim(aircraft, {12.0, 0.05, 0.5});
  const Result<controllers::Trim> left = controllers::find_trim(aircraft, {12.0, 0.05, -0.5});
  ASSERT_TRUE(right && left);
  EXPECT_NEAR(right->controls.aileron_rad, -left->controls.aileron_rad, 1e-10);
  EXPECT_NEAR(right->beta_rad, -left->beta_rad, 1e-10);
  EXPECT_NEAR(right->roll_rad, -left->roll_rad, 1e-10);
  EXPECT_NEAR(right->controls.throttle, left->controls.throttle, 1e-10);
  EXPECT_NEAR(right->pitch_rad, left->pitch_rad, 1e-10);
}

TEST(FlightTrim, FullThrottleClimbsByTheThrustLeftOver) {
  const AircraftNumbers numbers = make_mh900_like();
  const controllers::Aircraft aircraft = aircraft_of(numbers);
  const Result<controllers::Trim> climb =
      controllers::find_trim_at_throttle(aircraft, {12.0, 0.0, 0.0}, 1.0);
  ASSERT_TRUE(climb) << climb.reason();
  EXPECT_LT(acceleration_left(numbers, *climb), 1e-9);
  // By hand, forces along the path: T cos(alpha) - D = m g sin(climb), with the trim's alpha.
  const double V = 12.0, q_S = 0.5 * 1.225 * V * V * 0.27;
  const double thrust = 0.5 * 1.225 * 0.0314 * (25.0 * 25.0 - V * V);
  const double CL = 0.05 + 3.5 * climb->alpha_rad + 0.806 * climb->controls.elevator_rad;
  const double de = climb->controls.elevator_rad;
  const double drag = q_S * (0.025 + CL * CL / (M_PI * 0.85 * 3.0) + 0.15 * de * de);
  EXPECT_NEAR(std::sin(climb->request.climb_angle_rad),
              (thrust * std::cos(climb->alpha_rad) - drag) / (1.2 * 9.80665), 2e-4);
  // The same flight found from its climb angle.
  const Result<controllers::Trim> again =
      controllers::find_trim(aircraft, {12.0, climb->request.climb_angle_rad - 1e-9, 0});
  ASSERT_TRUE(again) << again.reason();
  EXPECT_NEAR(again->controls.throttle, 1.0, 1e-7);
}

TEST(FlightTrim, SaysWhyTheWingsDoNotCarry) {
  AircraftNumbers numbers = make_mh900_like();
  const controllers::Aircraft aircraft = aircraft_of(numbers);
  const Result<controllers::SpeedRange> range = controllers::find_speed_range(aircraft, 0.0, 0.0);
  ASSERT_TRUE(range) << range.reason();
  RecordProperty("slowest_mps", std::to_string(range->slowest_mps));
  RecordProperty("fastest_mps", std::to_string(range->fastest_mps));
  EXPECT_TRUE(controllers::find_trim(aircraft, {range->slowest_mps + 1e-3, 0.0, 0.0}));
  EXPECT_FALSE(controllers::find_trim(aircraft, {range->slowest_mps - 2e-3, 0.0, 0.0}));
  const Result<controllers::Trim> slow = controllers::find_trim(aircraft, {6.0, 0.0, 0.0});
  ASSERT_FALSE(slow);
  EXPECT_EQ(slow.reason(),
            "no steady flight at 6.00 m/s, climb 0.0 deg, bank 0.0 deg: it takes 11.8 N of lift "
            "and the wings give at most 5.7 N at 17.5 deg of incidence (lift coefficient 1.98 of "
            "at most 0.95); it can fly so from 8.64 to 22.34 m/s");
}

TEST(FlightTrim, SaysWhatThrottleAndElevonsWouldBeNeeded) {
  AircraftNumbers numbers = make_mh900_like();
  controllers::Aircraft aircraft = aircraft_of(numbers);
  const Result<controllers::Trim> steep = controllers::find_trim(aircraft, {12.0, 0.9, 0.0});
  ASSERT_FALSE(steep);
  EXPECT_EQ(
      steep.reason(),
      "no steady flight at 12.00 m/s, climb 51.6 deg, bank 0.0 deg: it takes throttle 1.034 of at "
      "most 1, full throttle gives a climb of 44.97 deg; it can fly so from 5.25 to 10.27 m/s");
  const Result<controllers::Trim> fast = controllers::find_trim(aircraft, {26.0, 0.0, 0.0});
  ASSERT_FALSE(fast);
  EXPECT_EQ(
      fast.reason(),
      "no steady flight at 26.00 m/s, climb 0.0 deg, bank 0.0 deg: it takes throttle 1.161 of at "
      "most 1, full throttle gives a climb of -20.73 deg; it can fly so from 8.64 to 22.34 m/s");
  // Far beyond, where nothing is solved, the wings lack no lift.
  const Result<controllers::Trim> absurd = controllers::find_trim(aircraft, {100.0, 0.0, 0.0});
  ASSERT_FALSE(absurd);
  EXPECT_EQ(absurd.reason(),
            "no steady flight at 100.00 m/s, climb 0.0 deg, bank 0.0 deg: lift, thrust and moments "
            "do not balance; it can fly so from 8.64 to 22.34 m/s");
  const Result<controllers::Trim> dive = controllers::find_trim(aircraft, {12.0, -0.8, 0.0});
  ASSERT_FALSE(dive);
  EXPECT_EQ(dive.reason(),
            "no steady flight at 12.00 m/s, climb -45.8 deg, bank 0.0 deg: even the least "
            "throttle, 0, gives a climb of -20.00 deg; it can fly so from 18.73 to 29.26 m/s");
  numbers.Cm0 = -0.15;  // nose-heavy
  const Result<controllers::Trim> heavy =
      controllers::find_trim(aircraft_of(numbers), {12.0, 0.0, 0.0});
  ASSERT_FALSE(heavy);
  EXPECT_EQ(heavy.reason(),
            "no steady flight at 12.00 m/s, climb 0.0 deg, bank 0.0 deg: the elevons, -25.0 to "
            "25.0 deg, balance it at no incidence; no speed is better");
}

TEST(FlightTrim, TheScaledZagiDoesNotFly) {
  // Reference, section 1: C_L 1.29 at 12 m/s and 1.2 kg on 0.104 m2.
  const Result<controllers::Trim> trim =
      controllers::find_trim(aircraft_of(make_scaled_zagi()), {12.0, 0.0, 0.0});
  ASSERT_FALSE(trim);
  EXPECT_EQ(trim.reason(),
            "no steady flight at 12.00 m/s, climb 0.0 deg, bank 0.0 deg: it takes 11.8 N of lift "
            "and the wings give at most 6.5 N at 12.0 deg of incidence (lift coefficient 1.28 of "
            "at most 0.71); it can fly so from 16.18 to 23.82 m/s");
}

}  // namespace
}  // namespace vinerow::test::flight_trim_test
