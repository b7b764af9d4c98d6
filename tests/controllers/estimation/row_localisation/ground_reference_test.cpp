// Both estimators on a map of rows over a slope, with the ground between the rows as a height
// reference.

#include "controllers/estimation/row_localisation/ground_reference.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/controllers/estimation/row_localisation/localisation_bench.h"
#include "tests/controllers/estimation/row_localisation/wall_map.h"

namespace vinerow::test::ground_reference_test {
namespace {

using Eigen::Vector3d;
using Text = std::string;

const WallBlock kSlope{.rows = 3, .to_m = 80.0, .grade_along = 0.18, .grade_across = 0.1};

std::vector<controllers::RangeSensorModel> make_sensors() {
  std::vector<controllers::RangeSensorModel> sensors = {make_range_sensor("left", 0.5 * kPi),
                                                        make_range_sensor("right", -0.5 * kPi)};
  // Looks along -z of B, 0.1 m ahead of its origin.
  controllers::RangeSensorModel down = make_range_sensor("down", 0.0);
  down.X_BS = {Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * kPi, Vector3d::UnitY())), {0.1, 0, 0}};
  sensors.push_back(down);
  return sensors;
}

/// Along the alley beside row 0, 1.25 m over the ground at a right angle, rolled and pitched; fixes
/// are 3 m too high all the time.
struct SlopeFlight {
  explicit SlopeFlight(LocalisationBench& rig) : bench(rig) {}
  Vector3d true_p_W() const {
    const double x = bench.now.s();
    const Vector3d foot(x, 1.25, wall_ground_m(kSlope, x, 1.25));
    return foot + 1.25 * wall_ground_normal(kSlope);
  }
  Odometry truth() const {
    Odometry odometry;
    odometry.X_WB = {quaternion_from_rpy({0.1, -0.05, 0.02}), true_p_W()};
    odometry.v_WB_B = odometry.X_WB.q.conjugate() * Vector3d(1.0, 0.0, kSlope.grade_along);
    return odometry;
  }
  /// Closed form: a ray from a point to the plane n.x = 0.
  double down_range() const {
    const Odometry at = truth();
    const Vector3d n = wall_ground_normal(kSlope);
    const Vector3d from = at.X_WB * Vector3d(0.1, 0, 0), dir = at.X_WB.q * Vector3d(0, 0, -1);
    return n.dot(from) / -n.dot(dir);
  }
  void tick() {
    bench.write_motion(truth(), truth());
    if (count % 20 == 0) bench.write_fix(true_p_W() + Vector3d(0, 0, 3), {1, 1, 1.5});
    if (count % 5 == 0) bench.write_range(2, down_range());
    ++count;
    bench.step();
  }
  /// Over the ground, at a right angle to it: fixes that are too high push the place uphill too.
  double height_error() const { return wall_ground_normal(kSlope).dot(bench.p_W()) - 1.25; }
  LocalisationBench& bench;
  int count = 0;
};

class GroundOf : public ::testing::TestWithParam<Text> {};

TEST_P(GroundOf, ASensorThatLooksDownTellsTheHeight) {
  const RowMap map = make_wall_map(kSlope);
  LocalisationBench blind(GetParam(), {}, &map, make_sensors());
  LocalisationBench bench(GetParam(), {{"down", Text("down")}}, &map, make_sensors());
  SlopeFlight without(blind), with(bench);
  for (int i = 0; i < 2000; ++i) without.tick(), with.tick();
  EXPECT_GT(without.height_error(), 0.5);
  // Fixes of 1.5 m that are 3 m off against heights of 0.05 m four times as often.
  EXPECT_NEAR(with.height_error(), 0.0, 0.01);
  EXPECT_EQ(bench.value("heights"), 400.0);
  EXPECT_EQ(bench.value("heights_gated"), 0.0);
  EXPECT_EQ(blind.value("heights"), 0.0);
  // A sensor that looks down looks at no wall.
  EXPECT_EQ(bench.value("echoes") + bench.value("echoes_gated"), 0.0);
}

TEST_P(GroundOf, RefusesHeightsThatAreNoneOrTooFarOff) {
  const RowMap map = make_wall_map(kSlope);
  LocalisationBench bench(GetParam(), {{"down", Text("down")}}, &map, make_sensors());
  SlopeFlight flight(bench);
  for (int i = 0; i < 500; ++i) flight.tick();
  const double accepted = bench.value("heights");
  const auto refused = [&] {
    return GetParam() == "distance_filter" ? bench.value("bad_numbers") : bench.value("refused");
  };
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), -1.0,
                           std::numeric_limits<double>::infinity(), 0.2}) {
    bench.write_motion(flight.truth(), flight.truth());
    bench.write_range(2, bad);
    bench.step();
  }
  EXPECT_EQ(refused(), 2.0);  // infinity says that nothing was seen
  EXPECT_EQ(bench.value("heights_gated"), 1.0);
  EXPECT_EQ(bench.value("heights"), accepted);
  EXPECT_EQ(Eigen::LLT<Eigen::Matrix3d>(bench.estimate.value().position_covariance()).info(),
            Eigen::Success);
}

/// Wheels on the slope, along the alley beside row 0 with the velocity, fixes and echoes that the
/// estimators take for granted.
struct SlopeDrive {
  SlopeDrive(const Text& type, const Values& values, std::uint64_t seed, bool flies = false)
      : map(make_wall_map(kSlope)), random(seed, "test", "drive") {
    vehicle.height_above_ground_m = 0.4;
    if (flies) vehicle.rotorcraft.emplace();
    bench.emplace(type, values, &map, make_sensors(), &vehicle, seed);
  }
  Pose true_pose() const {
    const Vector3d z = wall_ground_normal(kSlope);
    const Vector3d x = Vector3d(1, 0, kSlope.grade_along).normalized();
    Eigen::Matrix3d R;
    R << x, z.cross(x), z;
    const Vector3d foot(bench->now.s(), 1.25, wall_ground_m(kSlope, bench->now.s(), 1.25));
    return {Eigen::Quaterniond(R), foot + 0.4 * z};
  }
  void tick() {
    Odometry truth, ins;
    truth.X_WB = ins.X_WB = true_pose();
    // First-order Gauss-Markov, 0.05 m/s and 5 s.
    const double decay = std::exp(-0.01 / 5.0);
    for (int i = 0; i < 3; ++i) {
      slow_mps[i] = decay * slow_mps[i] + 0.05 * std::sqrt(1 - decay * decay) * random.normal();
    }
    const Vector3d v_W(1.0, 0.0, kSlope.grade_along);
    truth.v_WB_B = truth.X_WB.q.conjugate() * v_W;
    ins.v_WB_B = truth.X_WB.q.conjugate() * (v_W + slow_mps);
    bench->write_motion(truth, ins);
    if (count % 20 == 0) {
      const Vector3d error(random.normal(), random.normal(), 1.5 * random.normal());
      bench->write_fix(truth.X_WB.p + error, {1, 1, 1.5});
    }
    if (count++ % 5 == 0) {
      for (const int side : {0, 1}) {
        const Vector3d dir = truth.X_WB.q * Vector3d(0, side == 0 ? 1 : -1, 0);
        const double wall = side == 0 ? kSlope.pitch_m - kSlope.half_width_m : kSlope.half_width_m;
        bench->write_range(side, (wall - truth.X_WB.p.y()) / dir.y() + random.uniform(-3e-3, 3e-3));
      }
    }
    true_p_W = truth.X_WB.p;
    bench->step();
  }
  RowMap map;
  VehicleDescription vehicle;
  RandomStream random;
  std::optional<LocalisationBench> bench;
  Vector3d slow_mps = Vector3d::Zero(), true_p_W = Vector3d::Zero();
  int count = 0;
};

struct DriveErrors {
  double lateral_m, height_m, largest_height_m;  ///< rms of the first two; over the plane
};
DriveErrors drive(const Text& type, const Values& values) {
  DriveErrors errors{};
  int samples = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SlopeDrive drive(type, values, seed);
    for (int i = 0; i < 3000; ++i) {
      drive.tick();
      if (i < 100) continue;
      // Closed form: the origin of a body on wheels has n.p = 0.4 m.
      const double height_m = wall_ground_normal(kSlope).dot(drive.bench->p_W()) - 0.4;
      const double lateral_m = drive.bench->p_W().y() - drive.true_p_W.y();
      errors.height_m += height_m * height_m;
      errors.lateral_m += lateral_m * lateral_m;
      errors.largest_height_m = std::max(errors.largest_height_m, std::abs(height_m));
      ++samples;
    }
  }
  errors.height_m = std::sqrt(errors.height_m / samples);
  errors.lateral_m = std::sqrt(errors.lateral_m / samples);
  return errors;
}

TEST_P(GroundOf, WheelsFollowTheMappedSlope) {
  const DriveErrors with = drive(GetParam(), {});
  const DriveErrors without = drive(GetParam(), {{"on_ground", false}});
  RecordProperty("height_mm", std::to_string(1000 * with.height_m));
  RecordProperty("height_without_mm", std::to_string(1000 * without.height_m));
  RecordProperty("lateral_mm", std::to_string(1000 * with.lateral_m));
  RecordProperty("lateral_without_mm", std::to_string(1000 * without.lateral_m));
  EXPECT_GT(without.height_m, 0.2);
  // The plane is exact here: what is left is a velocity error of 0.05 m/s over the 0.2 s between.
  EXPECT_LT(with.height_m, 0.02);
  EXPECT_LT(with.largest_height_m, 0.06);
  EXPECT_LE(with.lateral_m, 1.02 * without.lateral_m);
}

TEST_P(GroundOf, WhatFliesDoesNotStand) {
  SlopeDrive rover(GetParam(), {}, 1), drone(GetParam(), {}, 1, true);
  for (int i = 0; i < 1000; ++i) rover.tick(), drone.tick();
  EXPECT_EQ(rover.bench->value("heights"), 50.0);  // every 0.2 s
  EXPECT_EQ(rover.bench->value("heights_gated"), 0.0);
  EXPECT_EQ(drone.bench->value("heights"), 0.0);
}

void expect_refused(const Text& type, const Values& values, const RowMap* map,
                    const Text& sentence) {
  try {
    LocalisationBench bench(type, values, map, make_sensors());
    ADD_FAILURE() << "not refused: " << sentence;
  } catch (const ConfigError& error) {
    EXPECT_NE(Text(error.what()).find(sentence), Text::npos) << error.what();
  }
}

TEST_P(GroundOf, NamesASensorThatIsNotThereAndAMapWithoutGround) {
  const RowMap map = make_wall_map(kSlope), one = make_wall_map({.rows = 1});
  const Text who = "robot.estimator (" + GetParam() + "): ";
  expect_refused(GetParam(), {{"down", Text("sonar")}}, &map,
                 who +
                     "down names 'sonar', but the vehicle's mounted sensors are: left, right, "
                     "down");
  expect_refused(GetParam(), {{"down", Text("down")}}, &one,
                 who +
                     "down is 'down', but the map has fewer than two rows, so its ground is "
                     "unknown");
}

TEST(GroundReference, IsNotThereWithoutTheMap) {
  const RowMap map = make_wall_map(kSlope);
  expect_refused("distance_filter", {{"down", Text("down")}, {"use_map", false}}, &map,
                 "down is 'down', but the map has fewer than two rows, so its ground is unknown");
}

TEST(GroundReference, IsLessSureOffTheRows) {
  const RowMap map = make_wall_map(kSlope);
  VehicleDescription rover;
  rover.height_above_ground_m = 0.4;
  EstimatorContext context;
  context.vehicle_description = &rover;
  controllers::GroundReference ground(controllers::GroundParams{}, context, &map, "test");
  const auto between = ground.read(Time{}, Eigen::Quaterniond::Identity(), {40, 1, 7});
  ASSERT_TRUE(between);
  EXPECT_NEAR((between->normal_W - wall_ground_normal(kSlope)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(between->offset_m, 0.4, 1e-9);
  EXPECT_NEAR(between->std_m, 0.05, 1e-9);
  EXPECT_FALSE(ground.read(Time{199'000'000}, Eigen::Quaterniond::Identity(), {40, 1, 7}));
  // 3 m beyond the ends, where the slope is known to 5 %.
  const auto beyond =
      ground.read(Time{200'000'000}, Eigen::Quaterniond::Identity(), {kSlope.to_m + 3, 1, 7});
  ASSERT_TRUE(beyond);
  EXPECT_NEAR(beyond->std_m, std::hypot(0.05, 0.15), 1e-9);
}

TEST_P(GroundOf, SaysWhyAVehicleCannotStandOnTheMap) {
  const Text who = "robot.estimator (" + GetParam() + "): on_ground is true, but ";
  const auto say = [&](const VehicleDescription* vehicle, const RowMap& map, const Text& why) {
    try {
      LocalisationBench bench(GetParam(), {{"on_ground", true}}, &map, make_sensors(), vehicle);
      ADD_FAILURE() << "not refused: " << why;
    } catch (const ConfigError& error) {
      EXPECT_NE(Text(error.what()).find(who + why), Text::npos) << error.what();
    }
  };
  VehicleDescription rover, drone;
  drone.rotorcraft.emplace();
  const RowMap map = make_wall_map(kSlope), one = make_wall_map({.rows = 1});
  say(&drone, map, "the vehicle flies");
  say(&rover, one, "the map has fewer than two rows, so its ground is unknown");
  say(nullptr, map, "the vehicle is unknown");
}

INSTANTIATE_TEST_SUITE_P(Estimators, GroundOf,
                         ::testing::Values("distance_filter", "map_localisation"),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace vinerow::test::ground_reference_test
