// What every registered controller of a rotorcraft keeps beside flying well
// (flight_conformance_test.cpp): phases, same bits, no heap, sentences.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "tests/controllers/support/quadrotor_loop.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::flight_contract_test {
namespace {

class FlightContract : public ::testing::TestWithParam<std::string> {
 protected:
  QuadrotorSetup make_setup() const {
    QuadrotorSetup setup;
    setup.controller.type = GetParam();
    setup.start.p = {0, 0, 2};
    return setup;
  }
};

TEST_P(FlightContract, FliesTheSameBitsTwice) {
  const auto fly = [&](std::uint64_t seed) {
    QuadrotorSetup setup = make_setup();
    setup.wind = gusty_wind({1, 2, 0}, 1.0, 1.0, 10.0, seed);
    QuadrotorLoop loop(setup);
    std::vector<Eigen::Vector3d> places;
    loop.run_until(5.0, [&] { places.push_back(loop.sim().state().p_W); });
    return places;
  };
  EXPECT_EQ(fly(1), fly(1));
  EXPECT_NE(fly(1), fly(2));
}

TEST_P(FlightContract, TakesOffLandsAndIsDone) {
  QuadrotorSetup setup = make_setup();
  setup.start.p = {0, 0, 0};
  setup.floor_m = 0.0;
  setup.rotors_on = false;
  // Waits 1 s, climbs 1.5 m in 3 s by a smooth step, stays 4 s, sinks by the same and on.
  setup.phase = [](double t) {
    return t < 1.0    ? Phase::kWait
           : t < 4.0  ? Phase::kTakeOff
           : t < 8.0  ? Phase::kHover
           : t < 14.0 ? Phase::kLand
                      : Phase::kDone;
  };
  setup.path = [](double t) {
    TrajectoryPoint at;
    const auto move = [&](double from_s, double rise_m) {
      const double s = std::clamp((t - from_s) / 3.0, 0.0, 1.0);
      at.p_W.z() += rise_m * s * s * s * (10.0 + s * (6.0 * s - 15.0));
      at.v_W.z() += rise_m * 30.0 * s * s * (1.0 - s) * (1.0 - s) / 3.0;
      at.a_W.z() += rise_m * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / 9.0;
    };
    move(1.0, 1.5);
    move(8.0, -2.0);
    return at;
  };
  QuadrotorLoop loop(setup);
  double overshoot_m = 0.0, off_m = 0.0, hardest_mps = 0.0, landed_radps = 0.0;
  loop.run_until(17.2, [&] {
    const QuadrotorState& state = loop.sim().state();
    const Phase phase = loop.reference().phase;
    overshoot_m = std::max(overshoot_m, state.p_W.z() - 1.5);
    if (phase == Phase::kHover && loop.time_s() > 6.0) off_m = std::abs(state.p_W.z() - 1.5);
    if (state.p_W.z() < 0.02) hardest_mps = std::max(hardest_mps, -state.v_W.z());
    double fastest_radps = 0.0;
    for (const double speed : loop.actuators()) {
      fastest_radps = std::max(fastest_radps, speed);
    }
    // Once it has landed they wind down within three seconds; it is done when they stand.
    const bool stand = loop.time_s() >= 14.0 + 3.0;
    if (stand || phase == Phase::kWait) {
      ASSERT_EQ(fastest_radps, 0.0) << loop.time_s();
    }
    if (phase == Phase::kDone) landed_radps = std::max(landed_radps, fastest_radps);
    ASSERT_EQ(loop.finished(), stand) << loop.time_s();
  });
  EXPECT_GT(landed_radps, 0.0);
  EXPECT_LT(overshoot_m, 0.15);
  EXPECT_LT(off_m, 0.03);
  EXPECT_LT(hardest_mps, 1.5);
  EXPECT_EQ(loop.sim().state().p_W.z(), 0.0);
  EXPECT_LT(loop.sim().state().p_W.head<2>().norm(), 0.05);
  EXPECT_TRUE(loop.follower().finished);
}

TEST_P(FlightContract, AllocatesNothing) {
  QuadrotorSetup setup = make_setup();
  setup.wind = gusty_wind({0, 3, 0}, 1.0, 1.0, 10.0, 1);
  setup.path = hover_at({3, 2, 4}, 1.0);  // limits become active
  QuadrotorLoop loop(setup);
  loop.run_until(0.2);
  std::size_t allocations = 0;
  loop.run_until(3.0, [&] {
    if (std::lround(loop.time_s() * 1000) % 50 != 0) return;
    AllocationCounter counter;
    loop.decide();
    allocations += counter.count();
  });
  EXPECT_EQ(allocations, 0u);
}

/// A controller alone between signals.
struct Bench : Loop {
  explicit Bench(const std::string& type, VehicleDescription vehicle = describe(make_q4t()))
      : Loop(
            {.vehicle = "drone", .description = std::move(vehicle), .tick = Duration{20'000'000}}) {
    add_controller({type, {}});
  }
  void expect_off() const {
    EXPECT_EQ(actuators(), std::vector<double>(4, 0.0));
    EXPECT_FALSE(finished());
  }
};

TEST_P(FlightContract, KeepsRotorsOffWithoutReferenceOrEstimate) {
  Bench bench(GetParam());
  bench.step();
  bench.expect_off();
  bench.step(Odometry{});
  bench.expect_off();
  ReferenceTrajectory empty;
  empty.phase = Phase::kHover;
  bench.write("reference", empty, Time{});
  bench.step();
  bench.expect_off();

  Bench blind(GetParam());
  empty.points.resize(21);
  blind.write("reference", empty);
  blind.step();
  blind.expect_off();
}

TEST_P(FlightContract, RefusesVehiclesWithoutRotors) {
  VehicleDescription rover = make_rover_description();
  rover.mass_kg = 300.0;
  try {
    Bench bench(GetParam(), rover);
    FAIL() << "must be refused";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.what(),
              "drone.controller (" + GetParam() +
                  ") needs a vehicle with rotors; vehicle type 'test_rover' has wheels");
  }
}

TEST_P(FlightContract, DocumentsItsParameters) {
  const PartSpec& spec = parts().spec(PartKind::kController, GetParam());
  for (const ParameterSpec& parameter : spec.parameters) {
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
  }
  EXPECT_GE(spec.default_rate_Hz, 20.0);
}

INSTANTIATE_TEST_SUITE_P(Controllers, FlightContract,
                         ::testing::ValuesIn(parts_that_write(PartKind::kController, "wrench")),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace vinerow::test::flight_contract_test
