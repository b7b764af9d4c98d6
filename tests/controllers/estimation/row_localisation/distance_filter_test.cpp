// The distance filter alone: bad input, stamps, and the estimator behind signals.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <limits>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/sensors.h"
#include "engine/core/error.h"
#include "tests/controllers/estimation/row_localisation/localisation_lab.h"
#include "tests/controllers/support/mission.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::distance_filter_test {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using Text = std::string;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

constexpr Time tick_time(std::int64_t tick) {
  return Time{tick * 10'000'000};
}

const LocalisationWorld& vines() {
  static const LocalisationWorld world({}, 1);
  return world;
}

/// Four sensors at X.
std::vector<controllers::RangeSensorModel> make_sensors() {
  std::vector<controllers::RangeSensorModel> sensors(4);
  for (int i = 0; i < 4; ++i) {
    sensors[i].name = "range" + std::to_string(i);
    sensors[i].X_BS.q = quaternion_from_rpy({0, 0, (0.25 + 0.5 * i) * 3.14159265358979});
    sensors[i].X_BS.p = sensors[i].X_BS.q * Vector3d(0.2, 0, 0);
  }
  return sensors;
}

/// A flight along the alley without errors but those a test puts in.
struct Flight {
  explicit Flight(const controllers::DistanceFilterParams& params = {})
      : sensors(make_sensors()),
        law(params, vines().map().accuracy, &vines().map_index(), sensors) {
    law.start(Time{}, p_W() + vines().place(0.1, -0.1, 0), 0.04 * Matrix3d::Identity());
  }
  Vector3d p_W() const { return vines().place(0.015 * static_cast<double>(tick), 0.1, 1.25); }
  Eigen::Quaterniond q_WB() const { return quaternion_from_rpy({0, 0, -0.5236}); }
  double range(int i) const {
    const Pose X_WS = Pose{q_WB(), p_W()} * sensors[i].X_BS;
    return vines().true_range(X_WS.p, X_WS.q * Vector3d::UnitX(), 4.0);
  }
  void predict() {
    const Vector3d before = p_W();
    ++tick;
    law.predict(now(), (p_W() - before) / 0.01, q_WB(), 0.0035);
  }
  void feed_ranges() {
    std::array<controllers::RangeReading, 4> readings;
    for (int i = 0; i < 4; ++i) readings[i] = {i, range(i), 4.0};
    law.take_ranges(now(), readings);
  }
  void fly(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      predict();
      if (tick % 20 == 0) law.take_fix(now(), p_W(), {1, 1, 1.5}, Vector3d::Zero());
      if (tick % 5 == 0) feed_ranges();
    }
  }
  Time now() const { return tick_time(tick); }
  double error() const { return (law.kalman().p_W() - p_W()).head<2>().norm(); }
  void expect_sound() const {
    EXPECT_TRUE(law.kalman().x().allFinite());
    EXPECT_EQ(Eigen::LLT<Matrix3d>(law.kalman().position_covariance()).info(), Eigen::Success);
    EXPECT_EQ(Eigen::LLT<Matrix3d>(law.set().shape_m2()).info(), Eigen::Success);
  }

  std::int64_t tick = 0;
  std::vector<controllers::RangeSensorModel> sensors;
  controllers::DistanceFilterLaw law;
};

TEST(DistanceFilterLaw, CountsNumbersThatAreNotFiniteAndGoesOn) {
  Flight flight;
  flight.fly(200);
  const auto x = flight.law.kalman().x();
  const std::array<controllers::RangeReading, 3> bad = {controllers::RangeReading{0, kNaN, 4.0},
                                                        controllers::RangeReading{1, -1.0, 4.0},
                                                        controllers::RangeReading{2, kInf, 4.0}};
  flight.predict();
  const auto predicted = flight.law.kalman().x();
  flight.law.take_ranges(flight.now(), bad);
  EXPECT_EQ(flight.law.counters().bad_numbers, 2);  // +infinity says: nothing seen
  flight.law.take_fix(flight.now(), {kNaN, 0, 0}, {1, 1, 1}, Vector3d::Zero());
  flight.law.take_fix(flight.now(), {0, 0, 0}, {1, 0, 1}, Vector3d::Zero());
  EXPECT_EQ(flight.law.counters().bad_numbers, 4);
  EXPECT_EQ(flight.law.kalman().x(), predicted);
  // A tick without velocity goes on with the last one known.
  ++flight.tick;
  flight.law.predict(flight.now(), {kNaN, 0, 0}, flight.q_WB(), 0.0035);
  EXPECT_EQ(flight.law.counters().bad_numbers, 5);
  EXPECT_NEAR((flight.law.kalman().x() - x).head<3>().norm(), 0.03, 0.003);
  flight.expect_sound();
  flight.fly(200);
  EXPECT_LT(flight.error(), 0.1);
}

TEST(DistanceFilterLaw, RefusesTimeThatGoesBackwards) {
  Flight flight;
  flight.fly(400);
  const auto x = flight.law.kalman().x();
  flight.law.predict(tick_time(399), {1, 0, 0}, flight.q_WB(), 0.0035);
  EXPECT_EQ(flight.law.counters().backwards, 1);
  // The same reading again, one from before it, a fix from before the memory (256 ticks).
  flight.feed_ranges();
  EXPECT_EQ(flight.law.counters().backwards, 5);
  const controllers::RangeReading old{0, 1.0, 4.0};
  flight.law.take_ranges(tick_time(390), {&old, 1});
  EXPECT_EQ(flight.law.counters().backwards, 6);
  flight.law.take_fix(tick_time(100), flight.p_W(), {1, 1, 1}, Vector3d::Zero());
  EXPECT_EQ(flight.law.counters().backwards, 7);
  EXPECT_EQ(flight.law.kalman().x(), x);
  flight.fly(100);
  EXPECT_LT(flight.error(), 0.1);
}

TEST(DistanceFilterLaw, LateDataAreComparedWithWhereTheVehicleWas) {
  // 0.5 s late at 1.5 m/s; then the estimate may not be drawn back by what the fix was behind.
  Flight flight;
  flight.fly(300);
  controllers::DistanceFilterParams params;
  Flight bare(params);
  for (int i = 0; i < 100; ++i) bare.predict();
  const double before = (bare.law.kalman().p_W() - bare.p_W()).norm();
  const Vector3d past = vines().place(0.015 * 50, 0.1, 1.25);
  bare.law.take_fix(tick_time(50), past, {0.001, 0.001, 0.001}, Vector3d::Zero());
  const Vector3d error = bare.law.kalman().p_W() - bare.p_W();
  EXPECT_GT(before, 0.1);
  EXPECT_LT(error.norm(), 0.03);  // velocity error of 0.05 m/s over 0.5 s, 1 sigma
  // What is newer than what is remembered is compared with now.
  bare.law.take_fix(tick_time(101), bare.p_W(), {1, 1, 1}, Vector3d::Zero());
  EXPECT_EQ(bare.law.counters().backwards, 0);
}

TEST(DistanceFilterLaw, RefusesContradictoryRangesAndRecovers) {
  Flight flight;
  flight.fly(300);
  const int accepted = flight.law.counters().echoes;
  // Something flies along, 0.3 m off every sensor: no wall explains that.
  for (int i = 0; i < 40; ++i) {
    flight.predict();
    if (flight.tick % 5 != 0) continue;
    std::array<controllers::RangeReading, 4> readings;
    for (int k = 0; k < 4; ++k) readings[k] = {k, 0.3, 4.0};
    flight.law.take_ranges(flight.now(), readings);
  }
  EXPECT_EQ(flight.law.counters().echoes, accepted);
  EXPECT_EQ(flight.law.counters().echoes_gated, 32);
  EXPECT_LT(flight.error(), 0.1);
  // For so long that the filter takes itself for lost: it opens up, and finds back.
  for (int i = 0; i < 600; ++i) {
    flight.predict();
    if (flight.tick % 5 != 0) continue;
    std::array<controllers::RangeReading, 4> readings;
    for (int k = 0; k < 4; ++k) readings[k] = {k, 0.1, 4.0};
    flight.law.take_ranges(flight.now(), readings);
  }
  flight.expect_sound();
  EXPECT_GE(flight.law.counters().lost, 1);
  flight.fly(1500);
  EXPECT_LT(flight.error(), 0.15);
}

TEST(DistanceFilterLaw, FindsBackByFixesFromAWrongPlace) {
  // The start is 60 m off, outside the map: fixes are refused until ten in a row agree.
  Flight flight;
  flight.law.start(flight.now(), flight.p_W() + Vector3d(60, 60, 0), 0.04 * Matrix3d::Identity());
  flight.fly(180);
  EXPECT_GT(flight.error(), 50.0);
  EXPECT_EQ(flight.law.counters().echoes, 0);
  EXPECT_GT(flight.law.counters().echoes_unmatched, 0);
  flight.expect_sound();
  flight.fly(1000);
  EXPECT_EQ(flight.law.counters().fixes_gated, 9);
  EXPECT_EQ(flight.law.counters().lost, 1);
  EXPECT_LT(flight.error(), 0.5);
}

TEST(DistanceFilterLaw, FliesOnBeyondTheMapAndPicksItUpAgain) {
  Flight flight;
  flight.fly(300);
  flight.tick = 0;
  controllers::DistanceFilterLaw& law = flight.law;
  // The rows end at s = 100 m: from there on there is no echo, and no harm.
  const auto place = [](int i) { return vines().place(95.0 + 0.015 * i, 0.1, 1.25); };
  law.start(tick_time(0), place(0), 0.01 * Matrix3d::Identity());
  for (int i = 1; i <= 1000; ++i) {
    law.predict(tick_time(i), (place(i) - place(i - 1)) / 0.01, flight.q_WB(), 0.0035);
    if (i % 20 == 0) law.take_fix(tick_time(i), place(i), {1, 1, 1.5}, Vector3d::Zero());
    if (i % 5 != 0) continue;
    const controllers::RangeReading nothing{0, kInf, 4.0}, ghost{1, 1.2, 4.0};
    const std::array<controllers::RangeReading, 2> both = {nothing, ghost};
    if (i > 600) law.take_ranges(tick_time(i), both);
  }
  EXPECT_GT(law.counters().echoes_unmatched, 0);
  EXPECT_LT((law.kalman().p_W() - place(1000)).norm(), 0.5);
  flight.expect_sound();
}

TEST(DistanceFilterLaw, ASliceOfTheMapReachesAsFarAsItsSensor) {
  controllers::DistanceFilterParams params;
  params.fusion = controllers::DistanceFusion::kJoint;
  params.association = controllers::EchoAssociation::kClosestSegment;
  Flight flight(params);
  flight.fly(300);
  const auto before = flight.law.counters();
  flight.predict();
  // No row within 0.5 m; those of the same moment that look farther see theirs.
  std::array<controllers::RangeReading, 4> readings;
  for (int i = 0; i < 4; ++i) readings[i] = {i, flight.range(i), 4.0};
  readings[0] = {0, 0.4, 0.5};
  flight.law.take_ranges(flight.now(), readings);
  EXPECT_EQ(flight.law.counters().echoes_unmatched, before.echoes_unmatched + 1);
  EXPECT_EQ(flight.law.counters().echoes, before.echoes + 3);
}

TEST(DistanceFilterLaw, CountsAPrintedEllipseThatIsNoCovariance) {
  controllers::DistanceFilterParams params;
  params.fusion = controllers::DistanceFusion::kReplace;
  params.printed_square_root = true;
  Flight flight(params);
  flight.fly(1000);
  EXPECT_GT(flight.law.counters().not_positive, 0);
  flight.expect_sound();
}

TEST(DistanceFilterLaw, NeitherAllocatesNorFailsInAnyMode) {
  for (const auto fusion :
       {controllers::DistanceFusion::kRangeEkf, controllers::DistanceFusion::kJoint,
        controllers::DistanceFusion::kJointEach, controllers::DistanceFusion::kReplace,
        controllers::DistanceFusion::kIncrement, controllers::DistanceFusion::kIncrementMatrix,
        controllers::DistanceFusion::kScalar, controllers::DistanceFusion::kTruncated}) {
    for (const auto association :
         {controllers::EchoAssociation::kRayCast, controllers::EchoAssociation::kClosestSegment}) {
      controllers::DistanceFilterParams params;
      params.fusion = fusion;
      params.association = association;
      Flight flight(params);
      flight.fly(100);
      std::size_t allocations = 0;
      {
        AllocationCounter counter;
        flight.fly(400);
        allocations = counter.count();
      }
      EXPECT_EQ(allocations, 0u);
      flight.expect_sound();
      EXPECT_LT(flight.error(), 0.3) << static_cast<int>(fusion);
      EXPECT_GT(flight.law.counters().echoes, 300);
    }
  }
}

/// The estimator between signals that a test writes by hand.
struct Bench {
  explicit Bench(const Values& values, const RowMap* map = &vines().map()) {
    Ports world(bus, "drone", "test");
    truth = world.write<Odometry>("truth");
    ins = world.write<Odometry>("ins");
    gps = world.write<GnssFix>("gps");
    for (const controllers::RangeSensorModel& sensor : make_sensors()) {
      ranges.push_back(world.write<RangeSample>(sensor.name));
      context.sensors.push_back({sensor.name, "ultrasound", sensor.X_BS});
    }
    context.vehicle = "drone";
    context.part = "drone.estimator";
    context.period = Duration{10'000'000};
    context.map = map;
    const PartSpec& spec = parts().spec(PartKind::kEstimator, "distance_filter");
    estimator = parts().make_estimator("distance_filter", make_parameters(spec, values), context);
    Ports ports(bus, "drone", "drone.estimator");
    estimator->connect(ports);
    estimate = world.read<Odometry>("estimate");
    ellipsoid = world.read<PositionEllipsoid>("ellipsoid");
    state = world.read<NamedValues>("estimator_state");
  }
  void tick(const Flight& flight, bool has_ranges = true) {
    Odometry odometry;
    odometry.X_WB = {flight.q_WB(), flight.p_W()};
    odometry.v_WB_B = flight.q_WB().conjugate() *
                      (1.5 * (vines().along_W() + Vector3d(0, 0, vines().setup().grade_along)));
    truth.write(flight.now(), odometry);
    ins.write(flight.now(), odometry);
    if (flight.tick % 20 == 0) {
      GnssFix fix;
      fix.valid = true;
      fix.p_W = flight.p_W() + flight.q_WB() * Vector3d(0, 0, 0.3);
      fix.std_m = {1, 1, 1.5};
      gps.write(flight.now(), fix);
    }
    if (flight.tick % 5 == 0 && has_ranges) {
      for (int i = 0; i < 4; ++i) {
        RangeSample sample;
        sample.range_m = flight.range(i);
        sample.max_range_m = 4.0;
        ranges[i].write(flight.now(), sample);
      }
    }
    estimator->step(flight.now());
  }
  double state_of(const Text& name) const {
    for (std::size_t i = 0; i < state.value().names.size(); ++i) {
      if (state.value().names[i] == name) return state.value().values[i];
    }
    return kNaN;
  }
  SignalBus bus;
  EstimatorContext context;
  std::unique_ptr<Estimator> estimator;
  SignalWriter<Odometry> truth, ins;
  SignalWriter<GnssFix> gps;
  std::vector<SignalWriter<RangeSample>> ranges;
  SignalReader<Odometry> estimate;
  SignalReader<PositionEllipsoid> ellipsoid;
  SignalReader<NamedValues> state;
};

TEST(DistanceFilter, EstimatesBetweenTheRows) {
  Bench bench({{"cone", false}, {"antenna_m", std::vector<double>{0, 0, 0.3}}});
  Flight flight;
  bench.tick(flight);
  const double start_error = (bench.estimate.value().X_WB.p - flight.p_W()).norm();
  EXPECT_GT(start_error, 0.01);  // drawn about the truth
  EXPECT_LT(start_error, 1.2);
  for (int i = 0; i < 2000; ++i) {
    ++flight.tick;
    bench.tick(flight);
  }
  const Odometry& estimate = bench.estimate.value();
  const Vector3d error = estimate.X_WB.p - flight.p_W();
  EXPECT_LT(error.head<2>().norm(), 0.2);
  EXPECT_NEAR(estimate.v_WB_B.head<2>().norm(), 1.5, 0.1);
  const Matrix3d P = estimate.position_covariance();
  EXPECT_EQ(Eigen::LLT<Matrix3d>(P).info(), Eigen::Success);
  EXPECT_LT(error.dot(P.inverse() * error), 16.3);  // chi-square, 3 degrees of freedom: 0.1 %
  const PositionEllipsoid& set = bench.ellipsoid.value();
  const Matrix3d shape = symmetric_matrix(set.shape_diagonal_m2, set.shape_beside_m2);
  const Vector3d off = flight.p_W() - set.centre_W;
  EXPECT_LT(off.dot(shape.inverse() * off), 1.0);
  EXPECT_EQ(bench.state_of("fixes"), 101.0);
  EXPECT_GT(bench.state_of("echoes"), 1400.0);
  EXPECT_EQ(bench.state_of("not_positive"), 0.0);
}

TEST(DistanceFilter, TakesAPoseFromOutside) {
  Bench bench({{"initial_pose_from_outside", true}, {"use_map", false}}, nullptr);
  const auto pose_out = static_cast<Signal<Odometry>*>(bench.bus.find("drone/initialpose"));
  Flight flight;
  for (flight.tick = 1; flight.tick < 125; ++flight.tick) bench.tick(flight, false);
  const double z_m = bench.estimate.value().X_WB.p.z();
  Odometry pose;
  pose.X_WB.p = flight.p_W() + Vector3d(3.0, -2.0, 50.0);
  pose.position_variance_m2 = {0.25, 0.09, 0.0};
  pose_out->write(flight.now(), pose);
  bench.tick(flight, false);
  const Odometry& moved = bench.estimate.value();
  // One tick of motion at 1.5 m/s lies between, and no fix.
  EXPECT_LT((moved.X_WB.p - pose.X_WB.p).head<2>().norm(), 0.02);
  EXPECT_NEAR(moved.X_WB.p.z(), z_m, 0.1);
  EXPECT_NEAR(moved.position_variance_m2.x(), 0.25, 0.01);
  EXPECT_NEAR(moved.position_variance_m2.y(), 0.09, 0.01);
  EXPECT_EQ(bench.bus.subscribe<Event>("drone/estimator_event", "test").value().level,
            Event::Level::kInfo);
}

TEST(DistanceFilter, TheSameSeedStartsTheSame) {
  const auto start = [](std::uint64_t seed) {
    Bench bench({});
    Bench other({});
    other.context.seed = seed;
    const PartSpec& spec = parts().spec(PartKind::kEstimator, "distance_filter");
    other.estimator =
        parts().make_estimator("distance_filter", make_parameters(spec, {}), other.context);
    SignalBus bus;
    Ports ports(bus, "drone", "drone.estimator"), world(bus, "drone", "test");
    other.estimator->connect(ports);
    world.write<Odometry>("truth").write(Time{}, Odometry{});
    other.estimator->step(Time{});
    return Vector3d(world.read<Odometry>("estimate").value().X_WB.p);
  };
  EXPECT_EQ(start(3), start(3));
  EXPECT_NE(start(3), start(4));
}

TEST(DistanceFilter, DoesWithoutAMapIfAsked) {
  Bench bench({{"use_map", false}}, nullptr);
  Flight flight;
  for (int i = 0; i < 500; ++i) {
    bench.tick(flight);
    ++flight.tick;
  }
  EXPECT_EQ(bench.state_of("echoes") + bench.state_of("echoes_unmatched"), 0.0);
  EXPECT_LT((bench.estimate.value().X_WB.p - vines().place(0.015 * 499, 0.1, 1.25)).norm(), 1.0);
}

void expect_refused(const Values& values, const RowMap* map, const Text& sentence) {
  try {
    Bench bench(values, map);
    ADD_FAILURE() << "not refused: " << sentence;
  } catch (const ConfigError& error) {
    EXPECT_NE(Text(error.what()).find(sentence), Text::npos) << error.what();
  }
}

TEST(DistanceFilter, RefusesAnEmptyMapAndSensorsThatAreNotThere) {
  const RowMap empty;
  expect_refused({}, &empty,
                 "drone.estimator (distance_filter): the map has no row meshes to compare ranges "
                 "with; give the vehicle a map with row meshes, or set use_map: false");
  expect_refused({}, nullptr, "the map has no row meshes");
  expect_refused({{"ranges", std::vector<Text>{"range0", "sonar"}}}, &vines().map(),
                 "ranges names 'sonar', but the vehicle's mounted sensors are: range0, range1, "
                 "range2, range3");
  // Each reading would count twice.
  expect_refused({{"ranges", std::vector<Text>{"range0", "range1", "range0"}}}, &vines().map(),
                 "ranges names 'range0' twice");
}

}  // namespace
}  // namespace vinerow::test::distance_filter_test
