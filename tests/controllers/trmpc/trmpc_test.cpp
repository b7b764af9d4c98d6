/// trmpc and mpc_nominal on a nonlinear aircraft with lags that is not the product's: limits in
/// gusts, the stress of the reference of paper A (14 m low, 24 deg off), and the laws that fail it.

#include "controllers/trmpc/trmpc.h"

#include <gtest/gtest.h>

#include <cmath>

#include "controllers/mpc_nominal/mpc_nominal.h"
#include "tests/controllers/parts/solvers/random_sets.h"
#include "tests/controllers/trmpc/wing_setup.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::trmpc_test {
namespace {

constexpr double kDegree = M_PI / 180.0;

struct Flown {
  int lon_states = 0, lon_inputs = 0, lat_states = 0, lat_inputs = 0;  // steps outside
  double elevator_rad = 0.0;
  double largest_violation = 0.0;  // of soft limits, by mpc
  double active_steps = 0;
  std::vector<LoopEvent> events;

  int outside() const { return lon_states + lon_inputs + lat_states + lat_inputs; }
};

/// One period of the controller, with a gust along the body's axes.
void tick(AircraftLoop& loop, const Eigen::Vector3d& gust) {
  loop.sim().set_body_gust(gust);
  loop.tick();
}

Flown fly(const WingSetup& setup, std::uint64_t seed, int steps) {
  AircraftLoop loop(setup);
  GaussMarkovGust gust(seed);
  Flown flown;
  for (int k = 0; k < steps; ++k) {
    tick(loop, gust.next());
    flown.lon_states += loop.deviation("outside_lon_states") > 0.0;
    flown.lon_inputs += loop.deviation("outside_lon_inputs") > 0.0;
    flown.lat_states += loop.deviation("outside_lat_states") > 0.0;
    flown.lat_inputs += loop.deviation("outside_lat_inputs") > 0.0;
    flown.elevator_rad = std::max(flown.elevator_rad, std::abs(loop.deviation("elevator_rad")));
    if (setup.controller.type == "fixed_wing_lqr") continue;
    flown.largest_violation =
        std::max({flown.largest_violation, loop.value("tube", "lon_soft_violation"),
                  loop.value("tube", "lat_soft_violation")});
    flown.active_steps +=
        loop.value("tube", "lon_active_rows") + loop.value("tube", "lat_active_rows") > 0.0;
  }
  flown.events = loop.events();
  return flown;
}

WingSetup stressed(const std::string& type, const Values& parameters = {}) {
  WingSetup setup;
  setup.controller = {type, parameters};
  setup.higher_m = -14.0;
  setup.turned_rad = 24.0 * kDegree;
  return setup;
}

TEST(Trmpc, FourteenMetresLowAndTwentyFourDegreesOffKeepsEveryLimitWhereTheLqrDoesNot) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const Flown lqr = fly(stressed("fixed_wing_lqr"), seed, 240);
    EXPECT_GT(lqr.lon_states, 10);  // the prototype's figures: 27 and 13
    EXPECT_GT(lqr.lon_inputs, 8);
    const Flown tube = fly(stressed("trmpc"), seed, 240);
    EXPECT_EQ(tube.outside(), 0);
    EXPECT_GT(tube.active_steps, 20);
    // One second ahead does not see the terminal set from 14 m below; three seconds do.
    EXPECT_GT(tube.largest_violation, 0.1);
    const Flown far = fly(stressed("trmpc", {{"horizon", std::int64_t{60}}}), seed, 240);
    EXPECT_EQ(far.outside(), 0);
    EXPECT_LT(far.largest_violation, 1e-3);
    EXPECT_EQ(far.events.size(), 1u);
  }
}

TEST(Trmpc, LawsWithoutTheTubeFailTheStress) {
  const Flown printed = fly(stressed("trmpc", {{"law", std::string("printed")}}), 0, 240);
  EXPECT_GT(printed.lon_inputs, 10);
  EXPECT_GT(printed.elevator_rad, 15.0 * kDegree);  // the limit is 10
  const Flown nominal = fly(stressed("mpc_nominal"), 0, 240);
  EXPECT_EQ(nominal.lon_inputs + nominal.lat_inputs, 0);
  EXPECT_GT(nominal.lon_states, 0);
  // 24 deg is outside the set of z_0 = x (23.1), 20 deg is not.
  WingSetup fixed = stressed("trmpc", {{"law", std::string("fixed_start")}});
  fixed.higher_m = 0.0;
  EXPECT_GT(fly(fixed, 0, 2).largest_violation, 0.03);
  fixed.turned_rad = 20.0 * kDegree;
  EXPECT_LT(fly(fixed, 0, 60).largest_violation, 1e-3);
  EXPECT_EQ(fly(fixed, 0, 60).outside(), 0);
}

TEST(Trmpc, TurbulenceOfOneMetrePerSecondViolatesNothing) {
  AircraftLoop loop(WingSetup{});
  double max_share = 0.0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    GaussMarkovGust gust(seed);
    for (int k = 0; k < 400; ++k) {
      tick(loop, gust.next());
      max_share = std::max(max_share, loop.deviation("limit_share"));
    }
  }
  EXPECT_LT(max_share, 1.0);
  EXPECT_GT(max_share, 0.2);
}

TEST(Trmpc, IsTheLqrToTheLastDigitsWhileNothingIsActive) {
  WingSetup lqr;
  lqr.controller.type = "fixed_wing_lqr";
  AircraftLoop tube(WingSetup{}), plain(lqr);
  GaussMarkovGust gust(4);
  for (int k = 0; k < 400; ++k) {
    const Eigen::Vector3d blow = gust.next();
    tick(tube, blow);
    tick(plain, blow);
    ASSERT_EQ(tube.value("tube", "lon_active_rows") + tube.value("tube", "lat_active_rows"), 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_NEAR(tube.actuators()[i], plain.actuators()[i], 1e-9);
    }
  }
}

TEST(Trmpc, TellsWhatItPromisesAndWhenSoftConstraintsTakeOver) {
  const std::vector<LoopEvent> events = fly(stressed("trmpc"), 0, 240).events;
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].text,
            "recursively feasible for gusts up to 2.09 m/s (longitudinal), 1.79 m/s (lateral)");
  EXPECT_EQ(events[1].text.rfind("longitudinal axis outside its tube by ", 0), 0u)
      << events[1].text;
  EXPECT_NE(events[1].text.find(" % of its terminal set; soft constraints take over"),
            std::string::npos);
  EXPECT_EQ(events[2].text.rfind("longitudinal axis back inside its tube after ", 0), 0u)
      << events[2].text;
  AircraftLoop loop(WingSetup{});
  loop.tick();
  EXPECT_NEAR(loop.value("tube", "lon_gust_mps"), 2.09, 0.01);
  EXPECT_NEAR(loop.value("tube", "lat_gust_mps"), 1.79, 0.01);
}

TEST(Trmpc, NeitherTakesHeapNorDependsOnAnythingButItsCalls) {
  for (const char* type : {"trmpc", "mpc_nominal"}) {
    AircraftLoop first(stressed(type)), second(stressed(type));
    GaussMarkovGust gust(5);
    for (int k = 0; k < 120; ++k) {
      const Eigen::Vector3d blow = gust.next();
      std::size_t allocations = 0;
      const std::size_t event_count = first.events().size();
      first.sense();
      {
        AllocationCounter counter;
        first.decide();
        allocations = counter.count();
      }
      first.sim().set_body_gust(blow);
      first.move();
      tick(second, blow);
      if (k > 0 &&
          first.events().size() == event_count) {  // a text and a signal's first value take heap
        EXPECT_EQ(allocations, 0u) << "tick " << k;
      }
      ASSERT_EQ(first.actuators(), second.actuators());
    }
  }
}

TEST(Trmpc, StandsAndEndsWithThePropellerOff) {
  WingSetup setup;
  AirReference wanted = setup.reference(0.0);
  AircraftLoop loop(setup);
  loop.set_inputs([&] { loop.write("reference", wanted); });
  wanted.phase = AirReference::Phase::kWait;
  loop.tick();
  EXPECT_EQ(loop.actuators()[0], 0.0);
  wanted.phase = AirReference::Phase::kStraight;
  loop.tick();
  EXPECT_GT(loop.actuators()[0], 0.3);
  // Over, but in the air: it flies on.
  wanted.phase = AirReference::Phase::kDone;
  loop.tick();
  EXPECT_GT(loop.actuators()[0], 0.3);
  wanted.power = false;
  loop.tick();
  EXPECT_EQ(loop.actuators(), (std::vector<double>{0.0, 0.0, 0.0}));
}

TEST(Trmpc, LostEstimateLeavesTheTrim) {
  WingSetup setup;
  AirReference wanted = setup.reference(0.0);
  AircraftLoop loop(setup);
  loop.set_inputs([&] { loop.write("reference", wanted); });
  loop.tick();
  const std::vector<double> trimmed = loop.actuators();
  wanted.height_m = std::nan("");
  loop.tick();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(loop.actuators()[i], trimmed[i], 1e-5);
}

TEST(Trmpc, RefusesWhatCannotBeKept) {
  const auto refused = [](const Values& values) {
    WingSetup setup;
    setup.controller.values = values;
    return complaint([&] { AircraftLoop loop(setup); });
  };
  EXPECT_EQ(refused({{"gust_mps", 1.9}}),
            "plane.controller (trmpc): gust_mps = 1.9 m/s: gusts alone take 107 % of the limit of "
            "aileron; the largest feasible gust is 1.78 m/s (lateral)");
  EXPECT_EQ(refused({{"gust_mps", 3.0}}),
            "plane.controller (trmpc): gust_mps = 3 m/s: gusts alone take 144 % of the limit of "
            "speed down; the largest feasible gust is 2.08 m/s (longitudinal)");
  // As recommended.
  EXPECT_EQ(refused({{"gust_mps", 1.78}}), "none");
  EXPECT_EQ(refused({{"gain", std::string("given")}}),
            "plane.controller (trmpc): gain is 'given', so longitudinal_gain must be");
  EXPECT_EQ(refused({{"lateral_gain", std::vector<double>(5, 0.0)}}),
            "plane.controller (trmpc): lateral_gain is used only with gain 'given'");
  EXPECT_EQ(refused({{"gain", std::string("given")},
                     {"longitudinal_gain", std::vector<double>(10, 0.0)},
                     {"lateral_gain", std::vector<double>(5, 0.0)}})
                .rfind("plane.controller (trmpc): longitudinal_gain does not stabilise the "
                       "longitudinal axis: A is not Schur stable",
                       0),
            0u);
}

// Weights and limits that leave no set are named, and no key that the part does not have.
TEST(MpcNominal, HasLimitsAndNoTube) {
  const std::vector<LoopEvent> events = fly(stressed("mpc_nominal"), 0, 240).events;
  int outside = 0;
  for (const LoopEvent& event : events) {
    EXPECT_EQ(event.text.find("its tube"), std::string::npos) << event.text;
    outside += event.text.find(" axis outside its limits by ") != std::string::npos;
  }
  EXPECT_GT(outside, 0);
}

TEST(MpcNominal, NamesTheWeightsAndLimitsThatLeaveNoSet) {
  const auto refused = [](const char* group, const char* name, double value) {
    WingSetup setup;
    setup.controller.type = "mpc_nominal";
    ParameterSet own =
        make_parameters(parts().spec(PartKind::kController, "mpc_nominal"), {}).make_group(group);
    own.set(name, value);
    setup.controller.values = {{group, std::vector<ParameterSet>{own}}};
    return complaint([&] { AircraftLoop loop(setup); });
  };
  const std::string who = "plane.controller (mpc_nominal): ";
  EXPECT_TRUE(refused("limits", "elevator_deg", 1e-6)
                  .starts_with(who + "no set of states of the longitudinal axis stays within "
                                     "'limits' at this rate_Hz; take limits and weights nearer"));
  EXPECT_TRUE(refused("weights", "phi_deg", 1e-4)
                  .starts_with(who + "the feedback that follows from 'weights' hardly steadies the "
                                     "lateral axis"));
}

}  // namespace
}  // namespace vinerow::test::trmpc_test
