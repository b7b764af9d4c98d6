// What every controller keeps, and what this one refuses.

#include <gtest/gtest.h>

#include <cmath>

#include "controllers/quadrotor_mpc/quadrotor_mpc.h"
#include "engine/core/error.h"
#include "tests/controllers/quadrotor_mpc/mpc_flight.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::contract_test {
namespace {

std::string refusal(const Values& values, const VehicleDescription& description,
                    double rate_Hz = 20.0) {
  try {
    Loop loop({.vehicle = "drone",
               .description = description,
               .tick = rate_Hz > 0.0 ? period_of_rate(rate_Hz) : Duration{}});
    loop.add_controller({"quadrotor_mpc", values});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(QuadrotorMpc, RefusesVehiclesWithoutRotors) {
  VehicleDescription rover;
  rover.type = "diff_rover";
  rover.mass_kg = 20.0;
  const std::string text = refusal({}, rover);
  EXPECT_EQ(
      text,
      "drone.controller (quadrotor_mpc) needs a vehicle with rotors; vehicle type 'diff_rover' "
      "has neither wheels nor rotors nor wings");
}

TEST(QuadrotorMpc, RefusesRotorsThatCannotHoverOrDoNotLag) {
  QuadrotorNumbers heavy = make_q4t();
  heavy.mass_kg = 12.0;
  EXPECT_NE(refusal({}, describe(heavy)).find("cannot hover"), std::string::npos);
  QuadrotorNumbers prompt = make_q4t();
  prompt.lag_s = 0.0;
  EXPECT_NE(refusal({}, describe(prompt)).find("rotor_lag_s"), std::string::npos);
}

TEST(QuadrotorMpc, RefusesBadNumbers) {
  const VehicleDescription q4t = describe(make_q4t());
  EXPECT_NE(refusal({}, q4t, 0.0).find("rate_Hz must be > 0"), std::string::npos);
  EXPECT_NE(refusal({{"horizon", std::int64_t{1}}}, q4t).find("horizon = 1"), std::string::npos);
  EXPECT_NE(refusal({{"horizon", std::int64_t{61}}}, q4t).find("60"), std::string::npos);
  EXPECT_NE(
      refusal({{"input_weight", std::vector<double>{0.02, 0.6, 0.0, 2}}}, q4t).find("input_weight"),
      std::string::npos);
  EXPECT_NE(refusal({{"position_weight", std::vector<double>{1, 2}}}, q4t).find("position_weight"),
            std::string::npos);
  EXPECT_NE(refusal({{"tilt_limit_deg", 90.0}}, q4t).find("tilt_limit_deg"), std::string::npos);
  EXPECT_EQ(refusal({}, q4t), "");
}

TEST(QuadrotorMpc, DocumentsItsParameters) {
  for (const ParameterSpec& parameter : controllers::quadrotor_mpc_spec().parameters) {
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
  }
}

TEST(QuadrotorMpc, KeepsTheRotorsOffOutsideFlight) {
  MpcSetup setup;
  setup.path = hover_at({0, 0, 0});
  setup.phase = [](double) { return Phase::kWait; };
  QuadrotorLoop loop(setup);
  loop.sim().set_floor(0.0);
  loop.tick();
  for (const double speed : loop.actuators()) EXPECT_EQ(speed, 0.0);
  EXPECT_FALSE(loop.finished());
  loop.set_phase(Phase::kHover);
  loop.tick();
  for (const double speed : loop.actuators()) EXPECT_GT(speed, 100.0);
  // Landed: what lifts fades within three seconds of 20 ticks, and never grows above what it was.
  const auto lift = [&] {
    double sum = 0.0;
    for (const double speed : loop.actuators()) sum += speed * speed;
    return sum;
  };
  const double landed = lift();
  loop.set_phase(Phase::kDone);
  for (int tick = 0; tick < 60; ++tick) {
    loop.tick();
    EXPECT_LE(lift(), (1.0 - tick / 60.0) * landed * (1.0 + 1e-9)) << tick;
    EXPECT_FALSE(loop.finished()) << tick;
  }
  loop.tick();
  for (const double speed : loop.actuators()) EXPECT_EQ(speed, 0.0);
  EXPECT_TRUE(loop.finished());
}

TEST(QuadrotorMpc, AllocatesNothingInFlight) {
  const RowsAndTurn rows = make_rows_and_turn();
  MpcSetup setup;
  setup.path = rows.path;
  setup.physics = Duration{5'000'000};
  QuadrotorLoop loop(setup);
  loop.sim().set_wind(gusty_wind({0, 3, 0}, 1.0, 4.0, rows.end_s, 1, 3));
  loop.tick();  // signals take their size
  std::size_t allocations = 0;
  while (loop.time_s() < 40.0) {
    loop.sense();
    {
      const AllocationCounter counter;
      loop.decide();
      allocations += counter.count();
    }
    loop.move();
  }
  EXPECT_EQ(allocations, 0u);
}

TEST(QuadrotorMpc, FliesTheSameBitsTwice) {
  const auto end = [] {
    MpcSetup setup;
    setup.path = straight({0, 0, 2}, 0.4, 3.0);
    QuadrotorLoop loop(setup);
    loop.sim().state().p_W.y() += 1.0;
    loop.sim().set_wind(gusty_wind({0, 3, 0}, 1.0, 4.0, 10.0, 1, 3));
    loop.run_until(5.0);
    return loop.sim().state();
  };
  const QuadrotorState a = end(), b = end();
  EXPECT_EQ(a.p_W, b.p_W);
  EXPECT_EQ(a.q_WB.coeffs(), b.q_WB.coeffs());
  EXPECT_EQ(a.rotors_radps, b.rotors_radps);
}

// A flight after another starts as the first did: nothing learnt is left.
TEST(QuadrotorMpc, ForgetsBetweenFlights) {
  MpcSetup setup;
  setup.path = hover_at({0, 0, 2});
  QuadrotorLoop loop(setup);
  loop.sim().set_wind([](double, const Eigen::Vector3d&) { return Eigen::Vector3d(0, 3, 0); });
  loop.run_until(4.0);
  EXPECT_GT(loop.value("mpc", "disturbance_y_N"), 0.5);
  loop.set_phase(Phase::kWait);
  loop.tick();
  loop.set_phase(Phase::kHover);
  loop.tick();
  EXPECT_EQ(loop.value("mpc", "disturbance_y_N"), 0.0);
}

TEST(QuadrotorMpc, DoesNotCareForThePlaceOrTheHeadingOfTheWorld) {
  const auto flown = [](double heading, const Eigen::Vector3d& place) {
    MpcSetup setup;
    setup.path = straight(place, heading, 3.0);
    QuadrotorLoop loop(setup);
    const Eigen::AngleAxisd turn(heading, Eigen::Vector3d::UnitZ());
    loop.sim().state().p_W += turn * Eigen::Vector3d(0.2, -0.4, 0.1);
    loop.run_until(3.0);
    return Eigen::Vector3d(loop.path_error());
  };
  const Eigen::Vector3d here = flown(0.0, {0, 0, 0});
  EXPECT_GT(here.norm(), 1e-6);
  for (const double heading : {1.0, -2.5, 3.1}) {
    EXPECT_LT((flown(heading, {500, -300, 200}) - here).norm(), 1e-9) << heading;
  }
}

}  // namespace
}  // namespace vinerow::test::contract_test
