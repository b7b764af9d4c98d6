/// What the scenario lets fail.

#include <gtest/gtest.h>

#include "tests/vehicles/quadrotor/rig.h"

namespace vinerow::vehicles::faults_test {
namespace {

using namespace test;

QuadrotorParams with_fault(QuadrotorFault fault) {
  QuadrotorParams params;
  params.faults = {fault};
  return params;
}

/// Texts of the events of a flight, one a step at most.
struct Listener {
  explicit Listener(QuadrotorRig& the_rig) : rig(the_rig) {
    Ports ports(bus, "drone", "drone");
    rig.vehicle.connect(ports);
    event = bus.subscribe<Event>("drone/vehicle_event", "test");
  }
  void run(double time_s) {
    for (auto i = std::llround(time_s / rig.dt.s()); i > 0; --i) {
      rig.step();
      if (event.sequence() == seen) continue;
      seen = event.sequence();
      texts.push_back(event.value().text);
      times_s.push_back(rig.now.s());
    }
  }
  QuadrotorRig& rig;
  SignalBus bus;
  SignalReader<Event> event;
  std::uint64_t seen = 0;
  std::vector<std::string> texts;
  std::vector<double> times_s;
};

TEST(QuadrotorFaults, AFailedRotorMakesItTumbleAndCrash) {
  QuadrotorRig rig(with_fault({QuadrotorFault::Kind::kRotorFailure, 0.5, 1, 0.0}));
  Listener listener(rig);
  rig.fly(20.0, rig.params.hover_radps());
  rig.actuate(rig.params.hover_radps());
  listener.run(0.5);
  EXPECT_LT(rig.tilt_rad(), 1e-9);
  listener.run(0.4);
  EXPECT_GT(rig.rates_B().head<2>().norm(), 3.0);
  EXPECT_LT(rig.vehicle.rotors()[1].speed_radps, 0.01 * rig.params.hover_radps());
  EXPECT_EQ(rig.crash(), "");  // not yet: it is in the air
  listener.run(5.0);
  EXPECT_EQ(rig.crash().substr(0, 17), "hit the ground at") << rig.crash();
  ASSERT_EQ(listener.texts.size(), 1u);
  EXPECT_EQ(listener.texts[0], "rotor 2 fails: 0 % of its thrust left");
  EXPECT_NEAR(listener.times_s[0], 0.501, 1e-9);
}

TEST(QuadrotorFaults, AShareOfTheThrustIsLeft) {
  QuadrotorRig rig(with_fault({QuadrotorFault::Kind::kRotorFailure, 0.0, 2, 0.6}));
  rig.fly(50.0, 280.0);
  rig.actuate(280.0);
  rig.run(1.0);
  EXPECT_NEAR(rig.vehicle.rotors()[2].thrust_N / rig.vehicle.rotors()[0].thrust_N, 0.6, 0.02);
  EXPECT_NEAR(rig.vehicle.rotors()[2].speed_radps, 280.0 * std::sqrt(0.6), 1e-3);
}

TEST(QuadrotorFaults, AnEmptyBatteryStopsTheRotors) {
  QuadrotorParams params;
  params.battery.initial_charge = 5e-4;  // 200 J
  QuadrotorRig rig(params);
  Listener listener(rig);
  rig.fly(20.0, params.hover_radps());
  rig.actuate(params.hover_radps());
  listener.run(6.0);
  const double power = 4.0 * 1.32e-6 * std::pow(params.hover_radps(), 3) / 0.75 + 15.0;
  ASSERT_EQ(listener.texts.size(), 1u);
  EXPECT_EQ(listener.texts[0], "battery empty: the rotors stop");
  EXPECT_NEAR(listener.times_s[0], 5e-4 * 111.0 * 3600.0 / power, 0.003);
  EXPECT_EQ(rig.vehicle.battery().charge, 0.0);
  EXPECT_EQ(rig.vehicle.battery().power_W, 0.0);
  EXPECT_EQ(rig.crash().substr(0, 17), "hit the ground at");
}

TEST(QuadrotorFaults, TheBatteryFailsWhenTheScenarioSaysSo) {
  QuadrotorParams params = with_fault({QuadrotorFault::Kind::kBatteryEmpty, 1.0, {}, {}});
  params.faults.push_back({QuadrotorFault::Kind::kRotorFailure, 1.0, 0, 0.0});
  QuadrotorRig rig(params);
  Listener listener(rig);
  rig.fly(20.0, params.hover_radps());
  rig.actuate(params.hover_radps());
  listener.run(1.0);
  EXPECT_NEAR(rig.vehicle.rotors()[0].speed_radps, params.hover_radps(), 1e-9);
  listener.run(0.5);
  EXPECT_LT(rig.vehicle.rotors()[3].speed_radps, 0.01 * params.hover_radps());
  // Two faults at once are reported one after the other.
  EXPECT_EQ(listener.texts.size(), 2u);
}

TEST(QuadrotorFaults, AnEmptyBatteryOnTheGroundIsNoCrash) {
  QuadrotorParams params;
  params.battery.initial_charge = 0.0;
  QuadrotorRig rig(params);
  Listener listener(rig);
  rig.actuate(400.0);
  listener.run(1.0);
  EXPECT_EQ(rig.crash(), "");
  EXPECT_NEAR(rig.body().X_WB.p.z(), 0.22, 1e-6);
  EXPECT_EQ(listener.texts.size(), 1u);
}

}  // namespace
}  // namespace vinerow::vehicles::faults_test
