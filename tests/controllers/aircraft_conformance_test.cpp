// What every registered controller of a vehicle on wings keeps, that is one that writes its
// "deviation" from steady flight. Rotorcraft: flight_conformance_test.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "tests/controllers/parts/solvers/random_sets.h"
#include "tests/controllers/support/aircraft_loop.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::aircraft_conformance_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class EveryAircraftController : public ::testing::TestWithParam<std::string> {
 protected:
  AircraftSetup make_setup() const {
    AircraftSetup setup;
    setup.controller.type = GetParam();
    return setup;
  }
  void record(const std::string& what, double value) {
    RecordProperty(what, std::to_string(value));
  }
};

double largest_deviation(const AircraftLoop& loop) {
  double largest = 0.0;
  for (const char* name :
       {"u_mps", "w_mps", "q_radps", "theta_rad", "h_m", "throttle", "elevator_rad", "v_mps",
        "p_radps", "r_radps", "phi_rad", "psi_rad", "aileron_rad"}) {
    largest = std::max(largest, std::abs(loop.deviation(name)));
  }
  return largest;
}

TEST_P(EveryAircraftController, HoldsSteadyFlightExactly) {
  // Straight on any course; climbs and turns as exactly as the table of trims is.
  for (const double course : {0.0, 1.0, kPi, -2.5}) {
    AircraftSetup setup = make_setup();
    setup.reference = fly_straight(course, 120.0);
    AircraftLoop loop(setup);
    loop.run_until(20.0);
    EXPECT_LT(largest_deviation(loop), 2e-3) << course;
    const Eigen::Vector3d along(std::cos(course), std::sin(course), 0.0);
    const Eigen::Vector3d p = loop.sim().truth().X_WB.p - Eigen::Vector3d(0, 0, 120.0);
    EXPECT_NEAR(p.dot(along), 240.0, 0.05) << course;
    EXPECT_LT((p - p.dot(along) * along).norm(), 0.05) << course;
  }
  for (const double bank : {-0.5, 0.6}) {
    for (const double climb : {-0.08, 0.0, 0.07}) {
      AircraftSetup setup = make_setup();
      setup.reference = fly_circle(0.4, 120.0, bank, climb);
      AircraftLoop loop(setup);
      double height_m = 0.0, heading_rad = 0.0;
      loop.run_until(20.0, [&] {
        height_m = std::max(height_m, std::abs(loop.deviation("h_m")));
        heading_rad = std::max(heading_rad, std::abs(loop.deviation("psi_rad")));
      });
      EXPECT_LT(height_m, 0.1) << bank << " " << climb;
      EXPECT_LT(heading_rad, rad_from_deg(0.5)) << bank << " " << climb;
    }
  }
}

TEST_P(EveryAircraftController, FliesEveryPlannedAirspeedAtItsHeight) {
  // Straight and in a climb, over the range of paper A and beyond; in still air, so that the
  // reference says all. 0.1 m/s is less than 1 % of the airspeed.
  for (const double airspeed_mps : {10.0, 11.0, 12.0, 13.3, 14.88, 16.5}) {
    for (const double climb_rad : {0.0, 0.05}) {
      AircraftSetup setup = make_setup();
      setup.reference = [&](double time_s) {
        AirReference reference = fly_straight(0.3, 120.0)(time_s);
        reference.airspeed_mps = airspeed_mps;
        reference.climb_angle_rad = climb_rad;
        reference.height_m = 120.0 + airspeed_mps * std::sin(climb_rad) * time_s;
        return reference;
      };
      AircraftLoop loop(setup);
      loop.run_until(40.0);
      const Odometry truth = loop.sim().truth();
      EXPECT_NEAR(truth.v_WB_B.norm(), airspeed_mps, 0.1) << climb_rad;
      EXPECT_NEAR(truth.X_WB.p.z(), loop.reference().height_m, 0.15)
          << airspeed_mps << " " << climb_rad;
    }
  }
}

TEST_P(EveryAircraftController, ComesBackFromOffsets) {
  const auto fly = [&](auto&& change) {
    AircraftSetup setup = make_setup();
    change(setup);
    AircraftLoop loop(setup);
    loop.run_until(30.0);
    return largest_deviation(loop);
  };
  EXPECT_LT(fly([](auto& s) { s.higher_m = 2.0; }), 0.05);
  EXPECT_LT(fly([](auto& s) { s.higher_m = -2.0; }), 0.05);
  EXPECT_LT(fly([](auto& s) { s.faster_mps = 1.5; }), 0.05);
  EXPECT_LT(fly([](auto& s) { s.faster_mps = -1.5; }), 0.05);
  EXPECT_LT(fly([](auto& s) { s.roll_rad = 0.35; }), 0.05);
  EXPECT_LT(fly([](auto& s) { s.pitch_rad = 0.15; }), 0.05);
  EXPECT_LT(fly([](auto& s) { s.turned_rad = 0.3; }), 0.05);
  EXPECT_LT(fly([](auto& s) { s.turned_rad = -0.3, s.roll_rad = -0.2, s.higher_m = 1.0; }), 0.05);
}

TEST_P(EveryAircraftController, MirrorsLeftAndRight) {
  const auto fly = [&](double side) {
    AircraftSetup setup = make_setup();
    setup.reference = fly_circle(0.0, 100.0, 0.4 * side);
    setup.turned_rad = 0.2 * side;
    setup.roll_rad = 0.2 * side;
    setup.higher_m = -1.0;
    setup.wind = [side](double time_s, const Eigen::Vector3d&) {
      return Eigen::Vector3d(0.3, -side * (1.0 + 0.5 * std::sin(time_s)), 0.0);
    };
    AircraftLoop loop(setup);
    std::vector<Eigen::Vector4d> track;
    loop.run_until(6.0, [&] {
      track.emplace_back(loop.deviation("h_m"), loop.deviation("throttle"),
                         side * loop.deviation("psi_rad"), side * loop.deviation("aileron_rad"));
    });
    return track;
  };
  const std::vector<Eigen::Vector4d> right = fly(1.0), left = fly(-1.0);
  ASSERT_EQ(right.size(), left.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    largest = std::max(largest, (right[i] - left[i]).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(largest, 1e-6);
  // And it is a flight, not a standstill.
  EXPECT_GT(std::abs(right[5](3)), 1e-3);
}

TEST_P(EveryAircraftController, FliesTheSameBitsTwice) {
  const auto fly = [&](std::uint64_t seed) {
    AircraftSetup setup = make_setup();
    setup.wind = markov_wind({1, 2, 0}, 1.0, 0.7, 10.0, seed);
    AircraftLoop loop(setup);
    std::vector<Eigen::Vector3d> places;
    loop.run_until(5.0, [&] { places.push_back(loop.sim().state().p_N); });
    return places;
  };
  EXPECT_EQ(fly(1), fly(1));
  EXPECT_NE(fly(1), fly(2));
}

TEST_P(EveryAircraftController, FliesLanesInGusts) {
  AircraftSetup setup = make_setup();
  setup.reference = fly_lanes(4);
  setup.wind = markov_wind({0, 0, 0}, 1.0, 0.6, 150.0, 1);
  AircraftLoop loop(setup);
  double height_m2 = 0.0, heading_rad2 = 0.0, max_share = 0.0;
  int ticks = 0;
  loop.run_until(120.0, [&] {
    height_m2 += std::pow(loop.deviation("h_m"), 2);
    heading_rad2 += std::pow(loop.deviation("psi_rad"), 2);
    max_share = std::max(max_share, loop.deviation("limit_share"));
    ++ticks;
  });
  const double height_m = std::sqrt(height_m2 / ticks);
  const double heading_deg = deg_from_rad(std::sqrt(heading_rad2 / ticks));
  // Reference of paper A, section 1, its worst controller (PID): 0.96 m and 4.06 deg.
  EXPECT_LT(height_m, 0.96);
  EXPECT_LT(heading_deg, 4.06);
  record("height_rms_m", height_m);
  record("heading_rms_deg", heading_deg);
  record("limit_share", max_share);
}

TEST_P(EveryAircraftController, HoldsHeightAndHeadingInASteadyWindItIsToldOf) {
  AircraftSetup setup = make_setup();
  const Eigen::Vector3d wind(3.0, -2.0, 0.0);
  setup.reference = [=](double time_s) {
    AirReference at = fly_straight(0.5, 100.0)(time_s);
    at.wind_W = wind;
    return at;
  };
  setup.wind = [=](double, const Eigen::Vector3d&) { return wind; };
  AircraftLoop loop(setup);
  loop.run_until(10.0);
  EXPECT_LT(largest_deviation(loop), 2e-3);
  const Eigen::Vector3d ground = loop.sim().truth().X_WB.q * loop.sim().truth().v_WB_B;
  EXPECT_NEAR((ground - wind).norm(), 12.0, 0.01);
}

TEST_P(EveryAircraftController, LaunchesWaitsEndsAndStopsThePropeller) {
  AircraftSetup setup = make_setup();
  setup.reference = [](double time_s) {
    AirReference at = fly_straight(0.0, 100.0, 0.1)(0.0);
    at.phase = time_s < 0.5   ? AirPhase::kWait
               : time_s < 2.0 ? AirPhase::kLaunch
               : time_s < 3.0 ? AirPhase::kStraight
               : time_s < 4.0 ? AirPhase::kLand
                              : AirPhase::kDone;
    at.power = at.phase == AirPhase::kLaunch || at.phase == AirPhase::kStraight;
    return at;
  };
  setup.roll_rad = 0.2;
  AircraftLoop loop(setup);
  const auto show = [&](double airspeed_mps) {
    Odometry odometry = loop.sim().truth();
    odometry.v_WB_B = {airspeed_mps, 0.0, 0.0};
    loop.set_estimate([odometry](Odometry& estimate) { estimate = odometry; });
  };
  const auto values = [&] { return loop.actuators(); };
  show(0.0);
  loop.run_until(0.3);
  EXPECT_EQ(values(), (std::vector<double>{0.0, 0.0, 0.0}));
  EXPECT_FALSE(loop.finished());
  // Below 0.8 of the airspeed: full throttle, elevator as trimmed, wings left alone.
  show(9.5);
  loop.run_until(0.8);
  EXPECT_EQ(values()[0], 1.0);
  EXPECT_EQ(values()[1], values()[2]);
  EXPECT_LT(std::abs(values()[1]), rad_from_deg(10.0));
  EXPECT_EQ(loop.deviation("outside_lon_states"), 0.0);
  // Faster it is flown: the roll of 0.2 rad to the right is taken out by aileron to the left.
  show(9.7);
  loop.run_until(1.1);
  EXPECT_LT(values()[1], values()[2]);
  show(12.0);
  loop.run_until(3.5);
  EXPECT_EQ(values()[0], 0.0);
  EXPECT_NE(values()[1], 0.0);
  EXPECT_FALSE(loop.finished());
  loop.run_until(4.2);
  EXPECT_EQ(values(), (std::vector<double>{0.0, 0.0, 0.0}));
  EXPECT_TRUE(loop.finished());
  EXPECT_TRUE(loop.follower().finished);
}

TEST_P(EveryAircraftController, FliesOnUnderPowerWhenItsMissionIsOver) {
  AircraftSetup setup = make_setup();
  setup.reference = [](double time_s) {
    AirReference at = fly_straight(0.5, 100.0)(time_s);
    if (time_s > 2.0) at.phase = AirPhase::kDone;
    return at;
  };
  setup.wind = markov_wind({0, 0, 0}, 0.5, 0.6, 30.0, 1);
  AircraftLoop loop(setup);
  loop.run_until(1.9);
  EXPECT_FALSE(loop.finished());
  loop.run_until(20.0);
  EXPECT_TRUE(loop.finished());
  EXPECT_TRUE(loop.follower().finished);
  EXPECT_NEAR(loop.sim().truth().X_WB.p.z(), 100.0, 2.0);
  EXPECT_LT(std::abs(loop.deviation("psi_rad")), rad_from_deg(10.0));
}

TEST_P(EveryAircraftController, KeepsPropellerOffWithoutReferenceOrEstimate) {
  for (const bool has_estimate : {false, true}) {
    Loop loop({.vehicle = "plane",
               .description = describe(make_mh900_like()),
               .tick = Duration{50'000'000}});
    loop.add_controller({GetParam(), {}});
    if (has_estimate) loop.write("estimate", Odometry{});
    if (!has_estimate) loop.write("reference", fly_straight(0.0, 10.0)(0.0));
    loop.step();
    EXPECT_EQ(loop.actuators(), (std::vector<double>{0.0, 0.0, 0.0}));
    EXPECT_FALSE(loop.finished());
  }
}

TEST_P(EveryAircraftController, AllocatesNothing) {
  AircraftSetup setup = make_setup();
  setup.wind = markov_wind({0, 3, 0}, 1.0, 0.0, 10.0, 1);
  setup.higher_m = -14.0;  // limits become active
  setup.turned_rad = 0.4;
  AircraftLoop loop(setup);
  loop.run_until(0.2);
  std::size_t allocations = 0;
  loop.run_until(5.0, [&] {
    AllocationCounter counter;
    loop.decide();
    allocations += counter.count();
  });
  EXPECT_EQ(allocations, 0u);
}

TEST_P(EveryAircraftController, KeepsItsOutputsFiniteWhateverItIsTold) {
  for (int broken = 0; broken < 6; ++broken) {
    AircraftSetup setup = make_setup();
    setup.reference = [=](double time_s) {
      AirReference at = fly_straight(0.0, 100.0)(time_s);
      if (time_s < 1.0) return at;
      if (broken == 3) at.heading_rad = kNan;
      if (broken == 4) at.bank_rad = kNan;
      if (broken == 5) at.height_m = kNan;
      return at;
    };
    AircraftLoop loop(setup);
    loop.run_until(1.0);
    Odometry odometry = loop.sim().truth();
    if (broken == 0) odometry.X_WB.p.z() = kNan;
    if (broken == 1) odometry.v_WB_B.x() = kNan;
    if (broken == 2) odometry.X_WB.q.x() = kNan;
    if (broken < 3) loop.set_estimate([odometry](Odometry& estimate) { estimate = odometry; });
    loop.run_until(2.0, [&] {
      for (const double value : loop.actuators()) {
        ASSERT_TRUE(std::isfinite(value)) << broken;
      }
      ASSERT_TRUE(std::isfinite(largest_deviation(loop))) << broken;
      ASSERT_TRUE(std::isfinite(loop.deviation("limit_share"))) << broken;
      ASSERT_TRUE(std::isfinite(loop.follower().heading_error_rad)) << broken;
    });
    // It recovers when the numbers do.
    loop.set_estimate({});
    if (broken >= 3) continue;
    loop.run_until(20.0);
    EXPECT_LT(largest_deviation(loop), 0.05) << broken;
  }
}

TEST_P(EveryAircraftController, KeepsActuatorsInTheirRanges) {
  AircraftSetup setup = make_setup();
  setup.higher_m = -30.0;
  setup.turned_rad = 2.5;
  AircraftLoop loop(setup);
  loop.run_until(10.0, [&] {
    const std::vector<double>& values = loop.actuators();
    ASSERT_TRUE(values[0] >= 0.0 && values[0] <= 1.0);
    for (int i = 1; i < 3; ++i) ASSERT_LE(std::abs(values[i]), rad_from_deg(25.0) + 1e-12);
    ASSERT_TRUE(loop.sim().state().velocity.allFinite());
  });
}

TEST_P(EveryAircraftController, RefusesVehiclesWithoutWingsAndThoseThatCannotFly) {
  const auto refusal = [&](const VehicleDescription& description) {
    return complaint([&] {
      Loop({.vehicle = "plane", .description = description, .tick = Duration{50'000'000}})
          .add_controller({GetParam(), {}});
    });
  };
  EXPECT_EQ(refusal(make_rover_description()),
            "plane.controller (" + GetParam() +
                ") needs a vehicle with wings; vehicle type 'test_rover' has wheels");
  EXPECT_EQ(refusal(describe(make_scaled_zagi()))
                .find("plane.controller (" + GetParam() +
                      "): no steady flight at 12.00 m/s, climb 0.0 deg, bank 0.0 deg: it takes "
                      "11.8 N of lift"),
            0u);
}

TEST_P(EveryAircraftController, DocumentsItsParameters) {
  const PartSpec& spec = parts().spec(PartKind::kController, GetParam());
  for (const ParameterSpec& parameter : spec.parameters) {
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
  }
  EXPECT_EQ(spec.default_rate_Hz, 20.0);
}

INSTANTIATE_TEST_SUITE_P(Controllers, EveryAircraftController,
                         ::testing::ValuesIn(parts_that_write(PartKind::kController, "deviation")),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace vinerow::test::aircraft_conformance_test
