// Deviations from steady flight, judged with the plain aircraft's own state in the signs of
// aviation.

#include "controllers/parts/aircraft/aircraft_ports.h"

#include <gtest/gtest.h>

#include "engine/core/constants.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/aircraft_loop.h"

namespace vinerow::test::aircraft_ports_test {
namespace {

/// Ports alone between signals.
struct Bench {
  Bench() {
    ControllerContext context;
    context.part = "plane.controller";
    context.period = Duration{50'000'000};
    context.vehicle_description = &description;
    ports.emplace(context, "test", limits);
    Ports wires(bus, "plane", "plane.controller");
    ports->connect(wires);
    actuators = world.read<NamedValues>("actuators");
    deviation = world.read<NamedValues>("deviation");
    follower = world.read<FollowerState>("follower");
  }
  void report_event(const Odometry& odometry, const AirReference& wanted) {
    estimate.write(Time{}, odometry);
    reference.write(Time{}, wanted);
    ports->take_over();
  }
  double value_of(const std::string& name) const {
    const NamedValues& values = deviation.value();
    for (std::size_t i = 0; i < values.names.size(); ++i) {
      if (values.names[i] == name) return values.values[i];
    }
    ADD_FAILURE() << name;
    return 0.0;
  }
  VehicleDescription description = describe(make_mh900_like());
  controllers::AircraftLimits limits;
  SignalBus bus;
  Ports world{bus, "plane", "test"};
  SignalWriter<Odometry> estimate = world.write<Odometry>("estimate");
  SignalWriter<AirReference> reference = world.write<AirReference>("reference");
  std::optional<controllers::AircraftPorts> ports;
  SignalReader<NamedValues> actuators, deviation;
  SignalReader<FollowerState> follower;
};

/// Steady flight to the north with these deviations, in the signs of aviation.
Odometry moved_from_trim(const controllers::TrimPoint& trim,
                         const controllers::AircraftDeviation& x, const Eigen::Vector3d& wind_W,
                         double psi, double height_m) {
  AircraftSim sim(make_mh900_like());
  sim.set_wind([=](double, const Eigen::Vector3d&) { return wind_W; });
  sim.start({10, 20, height_m + x.lon(4)}, trim.roll_rad + x.lat(3), trim.pitch_rad + x.lon(3),
            psi + x.lat(4), {trim.u_mps + x.lon(0), trim.v_mps + x.lat(0), trim.w_mps + x.lon(1)},
            {trim.p_radps + x.lat(1), trim.q_radps + x.lon(2), trim.r_radps + x.lat(2)},
            Eigen::Vector3d::Zero());
  sim.state().velocity += sim.state().velocity - sim.air_velocity();
  return sim.truth();
}

TEST(AircraftPorts, DeviationIsThatOfAviationInTheWind) {
  Bench bench;
  AirReference wanted = fly_straight(0.0, 90.0)(0.0);
  wanted.bank_rad = 0.3;
  wanted.climb_angle_rad = 0.05;
  wanted.wind_W = {2.0, -1.5, 0.3};
  controllers::AircraftDeviation x;
  x.lon << 0.5, -0.7, 0.2, 0.06, -3.0;
  x.lat << 0.8, -0.4, 0.3, 0.2, 0.15;
  const controllers::TrimPoint trim = bench.ports->trims().cruise().at(0.05, 0.3);
  for (const double psi : {0.0, 1.2, 3.1, -2.0}) {
    // A heading clockwise from north is 90 deg less it, from east to the left; whole turns do not
    // matter.
    wanted.heading_rad = 0.5 * kPi - psi + 4.0 * kPi;
    bench.report_event(moved_from_trim(trim, x, wanted.wind_W, psi, wanted.height_m), wanted);
    EXPECT_LT((bench.ports->deviation().lon - x.lon).cwiseAbs().maxCoeff(), 1e-12) << psi;
    EXPECT_LT((bench.ports->deviation().lat - x.lat).cwiseAbs().maxCoeff(), 1e-12) << psi;
  }
  EXPECT_EQ(bench.ports->trim().roll_rad, trim.roll_rad);
  bench.ports->write(Time{}, {0.1, 0.05, -0.04});
  EXPECT_NEAR(bench.value_of("h_m"), -3.0, 1e-12);
  EXPECT_NEAR(bench.value_of("psi_rad"), 0.15, 1e-12);
  EXPECT_NEAR(bench.value_of("aileron_rad"), -0.04, 1e-12);
  EXPECT_NEAR(bench.follower.value().heading_error_rad, -0.15, 1e-12);
}

TEST(AircraftPorts, AnotherAirspeedHasATrimOfItsOwn) {
  Bench bench;
  AirReference wanted = fly_straight(0.5 * kPi, 90.0)(0.0);
  wanted.airspeed_mps = 12.4;
  const controllers::Aircraft aircraft =
      controllers::read_aircraft(bench.description, kStandardGravity_mps2, "test");
  controllers::TrimRequest request;
  request.airspeed_mps = 12.4;
  const Result<controllers::Trim> trim = controllers::find_trim(aircraft, request);
  ASSERT_TRUE(trim) << trim.reason();
  controllers::TrimPoint point = bench.ports->trims().cruise().at(0.0, 0.0);
  const double cruise_u_mps = point.u_mps;
  point.u_mps = trim->u_mps;
  point.w_mps = trim->w_mps;
  point.pitch_rad = trim->pitch_rad;
  bench.report_event(moved_from_trim(point, {}, Eigen::Vector3d::Zero(), 0.0, 90.0), wanted);
  // Between tables 1 m/s apart.
  EXPECT_NEAR(bench.ports->deviation().lon.head<4>().norm(), 0.0, 5e-3);
  EXPECT_GT(12.4 - cruise_u_mps, 0.3) << "at the trim of the cruise speed it would deviate";
}

TEST(AircraftPorts, WritesTrimPlusDeviationWithinTheActuatorsRanges) {
  Bench bench;
  AirReference wanted = fly_straight(0.5 * kPi, 90.0)(0.0);
  const controllers::TrimPoint trim = bench.ports->trims().cruise().at(0.0, 0.0);
  bench.report_event(moved_from_trim(trim, {}, Eigen::Vector3d::Zero(), 0.0, 90.0), wanted);
  controllers::AircraftControls left = bench.ports->write(Time{}, {0.1, 0.05, 0.02});
  const double de = trim.controls.elevator_rad + 0.05, da = trim.controls.aileron_rad + 0.02;
  const std::vector<double>& values = bench.actuators.value().values;
  EXPECT_NEAR(values[0], trim.controls.throttle + 0.1, 1e-15);
  EXPECT_NEAR(values[1], de + da, 1e-15);
  EXPECT_NEAR(values[2], de - da, 1e-15);
  EXPECT_NEAR(left.throttle, 0.1, 1e-15);
  EXPECT_NEAR(left.elevator_rad, 0.05, 1e-15);
  EXPECT_NEAR(left.aileron_rad, 0.02, 1e-15);
  EXPECT_NEAR(bench.value_of("limit_share"), 0.4, 1e-12);  // throttle, of 0.25
  left = bench.ports->write(Time{}, {0.9, 0.0, 0.0});
  EXPECT_EQ(values[0], 1.0);
  EXPECT_NEAR(left.throttle, 1.0 - trim.controls.throttle, 1e-15);
  EXPECT_EQ(bench.value_of("outside_lon_inputs"), 1.0);
  EXPECT_EQ(bench.value_of("outside_lat_inputs"), 0.0);
  EXPECT_EQ(bench.value_of("outside_lon_states"), 0.0);
  wanted.power = false;
  bench.report_event(moved_from_trim(trim, {}, Eigen::Vector3d::Zero(), 0.0, 90.0), wanted);
  left = bench.ports->write(Time{}, {0.1, 0.0, 0.3});
  EXPECT_EQ(values[0], 0.0);
  EXPECT_EQ(left.throttle, 0.0);
  EXPECT_EQ(bench.value_of("outside_lon_inputs"), 0.0);
  EXPECT_EQ(bench.value_of("outside_lat_inputs"), 1.0);
}

TEST(AircraftPorts, JudgesEachStateByItsLimit) {
  const char* lon[] = {"outside_lon_states", "outside_lat_states"};
  for (int i = 0; i < 10; ++i) {
    Bench bench;
    const AirReference wanted = fly_straight(0.5 * kPi, 90.0)(0.0);
    const controllers::TrimPoint trim = bench.ports->trims().cruise().at(0.0, 0.0);
    for (const double share : {0.999, 1.001}) {
      controllers::AircraftDeviation x;
      (i < 5 ? x.lon(i) : x.lat(i - 5)) =
          -share * (i < 5 ? bench.limits.lon(i) : bench.limits.lat(i - 5));
      bench.report_event(moved_from_trim(trim, x, Eigen::Vector3d::Zero(), 0.0, 90.0), wanted);
      bench.ports->write(Time{}, {});
      EXPECT_NEAR(bench.value_of("limit_share"), share, 1e-9) << i;
      EXPECT_EQ(bench.value_of(lon[i < 5 ? 0 : 1]), share > 1.0 ? 1.0 : 0.0) << i;
      EXPECT_EQ(bench.value_of(lon[i < 5 ? 1 : 0]), 0.0) << i;
    }
  }
}

TEST(AircraftPorts, FollowerTellsWhatTheReferenceDoes) {
  Bench bench;
  AirReference wanted = fly_straight(0.0, 90.0)(0.0);
  wanted.cross_track_m = 1.5;
  wanted.distance_m = 100.0;
  wanted.remaining_m = 900.0;
  wanted.waypoint = 4;
  bench.report_event(Odometry{}, wanted);
  bench.ports->write(Time{}, {});
  EXPECT_EQ(bench.follower.value().lateral_error_m, 1.5);
  EXPECT_EQ(bench.follower.value().distance_m, 100.0);
  EXPECT_EQ(bench.follower.value().remaining_m, 900.0);
  EXPECT_EQ(bench.follower.value().waypoint, 4);
  EXPECT_FALSE(bench.follower.value().finished);
}

}  // namespace
}  // namespace vinerow::test::aircraft_ports_test
