#include "engine/sensors/camera_trigger.h"
#include "engine/api/messages/sensors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/engine/sensors/sensor_bench.h"
#include "tests/engine/sensors/sensor_parts.h"

namespace vinerow::sensors::camera_trigger_test {
namespace {

using Eigen::Vector3d;
using test::SensorValues;

// The RedEdge of paper A by its data sheet: f 5.4 mm, sensor 4.8 x 3.6 mm, 1280 pixels across.
constexpr double kAcross = 2.4 / 5.4, kAlong = 1.8 / 5.4, kPixel = 4.8 / 1280 / 5.4;

class CameraBench : public ::testing::Test {
 protected:
  void start(const SensorValues& values, double rate_Hz = 20.0) {
    sensor_ = make_camera_trigger(test::sensor_parameters("camera_trigger", values),
                                  bench_.context(rate_Hz));
    bench_.connect(*sensor_);
    shot_ = bench_.bus.subscribe<CameraShot>("rover/s", "test");
  }
  void refuse(const SensorValues& values, const std::string& sentence) {
    EXPECT_EQ(test::refusal_of([&] { start(values); }), sentence);
  }
  /// One tick of 50 ms. @returns whether it took a picture
  bool tick(const Vector3d& p_W, const RollPitchYaw& attitude = {},
            const Vector3d& v_B = {12, 0, 0}) {
    Odometry truth;
    truth.X_WB = {quaternion_from_rpy(attitude), p_W};
    truth.v_WB_B = v_B;
    bench_.truth.write(now_, truth);
    sensor_->step(now_);
    const bool is_new = shot_.is_newer_than(seen_);
    if (is_new) {
      EXPECT_EQ(shot_.stamp(), now_);
    }
    now_ = now_ + Duration{50'000'000};
    return is_new;
  }
  /// Flies east at a speed from x = 0 at y. @returns the ticks with a picture
  std::vector<int> fly(double speed_mps, int ticks, double y = 0.0) {
    std::vector<int> taken;
    for (int i = 0; i < ticks; ++i) {
      if (tick({speed_mps * 0.05 * i, y, 150}, {}, {speed_mps, 0, 0})) taken.push_back(i);
    }
    return taken;
  }
  const CameraShot& shot() const { return shot_.value(); }
  void expect_corner(int corner, double x, double y, double z = 0.0) const {
    EXPECT_NEAR((shot().corners_W[static_cast<std::size_t>(corner)] - Vector3d(x, y, z)).norm(),
                0.0, 1e-9)
        << corner << ": " << shot().corners_W[static_cast<std::size_t>(corner)].transpose();
  }

  test::SensorBench bench_;
  std::unique_ptr<Sensor> sensor_;
  SignalReader<CameraShot> shot_;
  std::uint64_t seen_ = 0;
  Time now_;
};

PathPoint point(double x, double y, PathKind kind, int alley) {
  PathPoint result;
  result.p_W = {x, y, 150};
  result.kind = kind;
  result.alley = alley;
  return result;
}

TEST_F(CameraBench, LevelFlightSeesTheFormulasRectangle) {
  start({{"on", std::string("always")}});
  ASSERT_TRUE(tick({10, 20, 150}, {0, 0, kPi / 2}));  // heading north
  EXPECT_EQ(shot().index, 0);
  EXPECT_TRUE(shot().on_ground);
  EXPECT_NEAR(shot().distance_m, 150.0, 1e-9);
  EXPECT_NEAR(shot().gsd_m, 0.1041666666666667, 1e-12);
  // 133.3 m across the track, 100 m along it; the upper left corner is ahead on the left: north
  // west.
  expect_corner(0, 10 - 200.0 / 3, 20 + 50);
  expect_corner(1, 10 + 200.0 / 3, 20 + 50);
  expect_corner(2, 10 + 200.0 / 3, 20 - 50);
  expect_corner(3, 10 - 200.0 / 3, 20 - 50);
  // x of S down, y to the left of the picture (west), z up in it (north).
  EXPECT_NEAR((shot().X_WS.q * Vector3d::UnitX() + Vector3d::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((shot().X_WS.q * Vector3d::UnitY() + Vector3d::UnitX()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((shot().X_WS.q * Vector3d::UnitZ() - Vector3d::UnitY()).norm(), 0.0, 1e-12);
}

TEST_F(CameraBench, ABankedCameraLooksToTheOtherSide) {
  start({{"on", std::string("always")}});
  const double roll = 0.3;
  ASSERT_TRUE(tick({0, 0, 100}, {roll, 0, 0}));  // right wing down, heading east
  // By hand: the left edge is seen at roll + alpha from the vertical, the right one at roll -
  // alpha; points of the left edge lie 100 / (cos(roll) - tan(alpha) sin(roll)) away along the
  // axis.
  const double alpha = std::atan(kAcross);
  const double left_m = 100.0 / (std::cos(roll) - kAcross * std::sin(roll)) * kAlong;
  const double right_m = 100.0 / (std::cos(roll) + kAcross * std::sin(roll)) * kAlong;
  expect_corner(0, left_m, 100.0 * std::tan(roll + alpha));
  expect_corner(1, right_m, 100.0 * std::tan(roll - alpha));
  expect_corner(2, -right_m, 100.0 * std::tan(roll - alpha));
  expect_corner(3, -left_m, 100.0 * std::tan(roll + alpha));
  EXPECT_NEAR(shot().distance_m, 100.0 / std::cos(roll), 1e-9);
  EXPECT_NEAR(shot().gsd_m, kPixel * 100.0 / std::cos(roll), 1e-12);
}

TEST_F(CameraBench, ACameraPitchedUpLooksAhead) {
  start({{"on", std::string("always")}});
  const double up = 0.2;
  ASSERT_TRUE(tick({0, 0, 100}, {0, -up, 0}));  // nose up, heading east
  const double beta = std::atan(kAlong);
  const double far_m = 100.0 / (std::cos(up) - kAlong * std::sin(up)) * kAcross;
  const double near_m = 100.0 / (std::cos(up) + kAlong * std::sin(up)) * kAcross;
  expect_corner(0, 100.0 * std::tan(up + beta), far_m);
  expect_corner(1, 100.0 * std::tan(up + beta), -far_m);
  expect_corner(2, 100.0 * std::tan(up - beta), -near_m);
  expect_corner(3, 100.0 * std::tan(up - beta), near_m);
}

TEST_F(CameraBench, ASlopeIsSeenWhereItIs) {
  bench_.scene.plane->rise_x = 0.25;
  start({{"on", std::string("always")}});
  ASSERT_TRUE(tick({40, 0, 110}));  // 100 m above the ground, heading uphill
  const double ahead_m = 100.0 / (1.0 + 0.25 * kAlong), behind_m = 100.0 / (1.0 - 0.25 * kAlong);
  const double front = 40 + ahead_m * kAlong, back = 40 - behind_m * kAlong;
  expect_corner(0, front, ahead_m * kAcross, 0.25 * front);
  expect_corner(2, back, -behind_m * kAcross, 0.25 * back);
  EXPECT_NEAR(shot().distance_m, 100.0, 1e-9);
}

TEST_F(CameraBench, PlantsAndWallsAreNotTheGround) {
  bench_.scene.add_wall(5.0);
  start({{"on", std::string("always")}});
  ASSERT_TRUE(tick({0, 0, 150}));
  expect_corner(0, 50, 200.0 / 3);
}

TEST_F(CameraBench, AboveTheHorizonIsNoGround) {
  start({{"on", std::string("always")}});
  ASSERT_TRUE(tick({0, 0, 100}, {0, -1.3, 0}));  // 74 degrees up; 18 more to the upper edge
  EXPECT_FALSE(shot().on_ground);
  EXPECT_NEAR(shot().distance_m, 100.0 / std::cos(1.3), 1e-9) << "the axis still meets it";
  EXPECT_EQ(shot().corners_W[0], Vector3d::Zero());
}

const std::pair<std::string, ParameterSet::Value> kAlways = {"on", std::string("always")},
                                                  kGimbal = {"mount", std::string("gimbal")};

TEST_F(CameraBench, AGimbalTakesBankAndPitchOut) {
  start({kAlways, kGimbal});
  // Banked by 20 deg, nose up by 8, heading north: the level rectangle of 133.3 x 100 m.
  ASSERT_TRUE(tick({0, 0, 150}, {rad_from_deg(20.0), rad_from_deg(-8.0), kPi / 2}));
  expect_corner(0, -200.0 / 3, 50);
  expect_corner(1, 200.0 / 3, 50);
  expect_corner(2, 200.0 / 3, -50);
  expect_corner(3, -200.0 / 3, -50);
  EXPECT_NEAR(shot().gsd_m, kPixel * 150.0, 1e-12);
}

TEST_F(CameraBench, AGimbalKeepsAnObliqueCamerasAngle) {
  start({kAlways, kGimbal, {"rotation_deg", std::vector<double>{0.0, 60.0, 0.0}}});
  ASSERT_TRUE(tick({0, 0, 150}, {rad_from_deg(-20.0), rad_from_deg(10.0), 0.0}));
  // 30 deg from the vertical, ahead (east).
  const Vector3d axis_W = shot().X_WS.q * Vector3d::UnitX();
  EXPECT_NEAR((axis_W - Vector3d(0.5, 0.0, -std::sqrt(0.75))).norm(), 0.0, 1e-12);
}

TEST_F(CameraBench, BeyondTheGimbalsLimitTheRestRemains) {
  start({kAlways, kGimbal, {"gimbal_limit_deg", 12.0}, {"gimbal_lag_s", 0.0}});
  const double rest = rad_from_deg(8.0);
  ASSERT_TRUE(tick({0, 0, 100}, {rad_from_deg(20.0), 0, 0}));  // right wing down, heading east
  // As fixed to a vehicle that is banked by 8 deg: the left edge is seen at 8 deg more.
  const double left_m = 100.0 / (std::cos(rest) - kAcross * std::sin(rest)) * kAlong;
  expect_corner(0, left_m, 100.0 * std::tan(rest + std::atan(kAcross)));
  EXPECT_NEAR(shot().distance_m, 100.0 / std::cos(rest), 1e-9);
  for (int i = 0; i < 19; ++i) tick({0, 0, 100});
  ASSERT_TRUE(tick({0, 0, 100}, {0, rad_from_deg(-20.0), 0}));  // nose up
  const double far_m = 100.0 / (std::cos(rest) - kAlong * std::sin(rest)) * kAcross;
  expect_corner(0, 100.0 * std::tan(rest + std::atan(kAlong)), far_m);
}

TEST_F(CameraBench, AGimbalLagsBehindARoll) {
  start({kAlways, kGimbal, {"gimbal_lag_s", 1.0}});
  const double rate_radps = 0.4;
  // Rolling evenly from level: rate T (1 - exp(-t / T)) of it remains, and fades when it stops.
  const double after_roll = rate_radps * (1.0 - std::exp(-1.0));
  for (int i = 0; i <= 20; ++i) tick({0, 0, 150}, {rate_radps * 0.05 * i, 0, 0});
  ASSERT_EQ(shot().index, 1);
  const auto tilt = [&] {
    const Vector3d axis_W = shot().X_WS.q * Vector3d::UnitX();
    EXPECT_NEAR(axis_W.x(), 0.0, 1e-12);
    return std::atan2(axis_W.y(), -axis_W.z());
  };
  EXPECT_NEAR(tilt(), after_roll, 1e-12) << "right wing down: looks to the left";
  for (int i = 0; i < 20; ++i) tick({0, 0, 150}, {rate_radps, 0, 0});
  ASSERT_EQ(shot().index, 2);
  EXPECT_NEAR(tilt(), after_roll * std::exp(-1.0), 1e-12);
}

TEST_F(CameraBench, PicturesComeByTime) {
  start({{"on", std::string("always")}});
  EXPECT_EQ(fly(12, 70), (std::vector<int>{0, 20, 40, 60})) << "the RedEdge takes one per second";
  EXPECT_EQ(shot().index, 3);
}

TEST_F(CameraBench, AnIntervalBetweenTicksWaitsForTheNext) {
  start({{"on", std::string("always")}, {"interval_s", 1.02}});
  EXPECT_EQ(fly(12, 70), (std::vector<int>{0, 21, 42, 63}));
}

TEST_F(CameraBench, PicturesComeByDistance) {
  start({{"on", std::string("always")}, {"distance_m", 15.0}});
  // 0.5 m per tick: every 30 ticks.
  EXPECT_EQ(fly(10, 100), (std::vector<int>{0, 30, 60, 90}));
}

TEST_F(CameraBench, NeverFasterThanTheCamera) {
  start({{"on", std::string("always")}, {"distance_m", 5.0}});
  EXPECT_EQ(fly(12, 50), (std::vector<int>{0, 20, 40})) << "12 m per second, 5 m wanted";
}

TEST_F(CameraBench, OnLanesOnly) {
  start({});
  EXPECT_TRUE(fly(12, 40).empty()) << "nothing is planned yet";
  PlannedPath path;
  path.points = {point(-50, 0, PathKind::kTransit, -1), point(24, 0, PathKind::kLeg, 0),
                 point(48, 0, PathKind::kTurn, -1),     point(48, 60, PathKind::kLeg, 1),
                 point(0, 60, PathKind::kReturn, -1),   point(-50, 0, PathKind::kReturn, -1)};
  bench_.plan.write(now_, path);
  // 0.6 m per tick: the lane begins at tick 40 and ends at tick 80.
  EXPECT_EQ(fly(12, 100), (std::vector<int>{40, 60, 80}));
  EXPECT_EQ(shot().index, 2);
  // Across the second lane, as on a way home: no picture.
  for (int i = 0; i < 40; ++i) {
    EXPECT_FALSE(tick({24, 50.0 + 0.5 * i, 150}, {0, 0, kPi / 2})) << i;
  }
}

/// The estimate is 6 m ahead of the truth: at 0.6 m a tick pictures are due 10 ticks earlier, and
/// show what the true place sees.
TEST_F(CameraBench, IsReleasedByTheEstimate) {
  SignalWriter<Odometry> estimate = bench_.bus.advertise<Odometry>("rover/estimate", "test");
  start({});
  PlannedPath path;
  path.points = {point(-50, 0, PathKind::kTransit, -1), point(24, 0, PathKind::kLeg, 0),
                 point(48, 0, PathKind::kTurn, -1), point(48, 60, PathKind::kLeg, 1)};
  bench_.plan.write(now_, path);
  std::vector<int> taken;
  for (int i = 0; i < 60; ++i) {
    const Vector3d p_W(0.6 * i, 0, 150);
    Odometry known;
    known.X_WB.p = p_W + Vector3d(6.3, 0, 0);
    known.v_WB_B = {12, 0, 0};
    estimate.write(now_, known);
    if (!tick(p_W)) continue;
    taken.push_back(i);
    EXPECT_NEAR((shot().X_WS.p - p_W).norm(), 0.0, 1e-9) << i;
  }
  EXPECT_EQ(taken, (std::vector<int>{30, 50}));
}

TEST_F(CameraBench, ALaneBeginsWithAPicture) {
  start({{"distance_m", 100.0}});
  PlannedPath path;
  path.points = {point(0, 0, PathKind::kLeg, 0), point(60, 0, PathKind::kTurn, -1),
                 point(60, 40, PathKind::kLeg, 1), point(0, 40, PathKind::kLeg, 1)};
  bench_.plan.write(now_, path);
  EXPECT_EQ(fly(12, 95), (std::vector<int>{0}));
  // On the second lane at once, although the last picture was taken 72 m away.
  EXPECT_TRUE(tick({59, 40, 150}, {0, 0, kPi}));
}

TEST_F(CameraBench, RefusesWhatTheCameraCannotDo) {
  refuse(
      {{"interval_s", 0.5}},
      "rover.sensors.s: interval_s = 0.5 s, must be at least 1 s: camera 'rededge' takes at most "
      "1 picture per second");
  refuse({{"interval_s", 2.0}, {"distance_m", 10.0}},
         "rover.sensors.s: interval_s = 2 s and distance_m = 10 m are both given, must be one of "
         "them");
}

TEST_F(CameraBench, LanesNeedAPlanner) {
  SignalBus bus;
  bus.advertise<Odometry>("rover/truth", "rover");
  const auto connect = [&](const char* on) {
    ParameterSet parameters(camera_trigger_spec().parameters, "camera_trigger");
    parameters.set("on", std::string(on)).set("distance_m", 3.0);
    SensorContext context = bench_.context(20.0);
    context.name = on;
    const auto sensor = make_camera_trigger(parameters, context);
    Ports ports(bus, "rover", "rover.sensors.s");
    sensor->connect(ports);
  };
  connect("always");
  EXPECT_NO_THROW(bus.check_connected());
  connect("lanes");
  EXPECT_THROW(bus.check_connected(), ConfigError);
}

}  // namespace
}  // namespace vinerow::sensors::camera_trigger_test
