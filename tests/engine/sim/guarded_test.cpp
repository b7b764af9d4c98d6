/// What the kernel makes of exceptions of parts.

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "engine/api/signal.h"
#include "engine/core/error.h"
#include "engine/sim/vehicle_assembly.h"

namespace vinerow::guarded_test {
namespace {

/// Kind and sentence of what a guarded tick throws.
template <class Thrown>
std::string thrown_at(Time now, const Thrown& thrown) {
  const SignalBus bus;
  const scenario::PartConfig config{
      "stove", 1.0, {}, {"cabin.yaml", 12}, {{"heat_W", {"cabin.yaml", 14}}}};
  const auto tick = guarded(bus, "rover.heater", config, [&](Time) { throw thrown; });
  try {
    tick(now);
  } catch (const ConfigError& error) {
    return std::string("bad input: ") + error.what();
  } catch (const SimulationError& error) {
    return std::string("broke off: ") + error.what();
  }
  return "nothing";
}

TEST(Guarded, WhatAPartRefusesAtTheStartIsBadInput) {
  EXPECT_EQ(thrown_at(Time{0}, ConfigError("no wood")),
            "bad input: cabin.yaml:12: rover.heater: no wood");
  EXPECT_EQ(thrown_at(Time{0}, ConfigError("heat_W = 9 W needs wood")),
            "bad input: cabin.yaml:14: rover.heater: heat_W = 9 W needs wood");
  EXPECT_EQ(thrown_at(Time{1'000'000'000}, ConfigError("no wood")),
            "broke off: t = 1.000000 s: rover.heater (stove): no wood");
}

TEST(Guarded, OtherExceptionsBreakTheRunOff) {
  EXPECT_EQ(thrown_at(Time{0}, std::runtime_error("smoke")),
            "broke off: t = 0.000000 s: rover.heater (stove): threw an exception: smoke");
  EXPECT_EQ(thrown_at(Time{0}, 42),
            "broke off: t = 0.000000 s: rover.heater (stove): threw an exception of unknown type");
}

}  // namespace
}  // namespace vinerow::guarded_test
