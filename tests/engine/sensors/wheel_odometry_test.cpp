#include "engine/sensors/wheel_odometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/sensors/wheel_motion.h"
#include "tests/engine/sensors/sensor_bench.h"
#include "tests/engine/sensors/sensor_parts.h"

namespace vinerow::sensors::wheel_odometry_test {
namespace {

using test::SensorBench;

constexpr double kRadius_m = 0.2, kTrack_m = 0.8, kFront_m = 0.7, kRear_m = 0.5;
constexpr double kPeriod_s = 0.02;
const test::SensorValues kIdeal = {{"angle_resolution_rad", 0.0},   {"angle_noise_std_rad", 0.0},
                                   {"speed_resolution_radps", 0.0}, {"speed_noise_std_radps", 0.0},
                                   {"radius_error_std", 0.0},       {"track_error_std", 0.0}};

enum class Steering { kSkid, kFront, kBoth };

/// Four wheels, all driven. @param effective  effective track per track
VehicleDescription make_vehicle(Steering steering, double effective = 0.0) {
  VehicleDescription vehicle;
  vehicle.type = "fixed";
  if (steering != Steering::kSkid) {
    vehicle.actuators.push_back({"axle_front_steer_rad", "rad", -1.0, 1.0});
  }
  if (steering == Steering::kBoth) {
    vehicle.actuators.push_back({"axle_rear_steer_rad", "rad", -1.0, 1.0});
    vehicle.steered = SteeredVehicle{.front_axle_m = kFront_m, .rear_axle_m = kRear_m};
  } else if (steering == Steering::kFront) {
    vehicle.ackermann = AckermannVehicle{.rear_axle_m = kRear_m};
  }
  WheeledVehicle& wheeled = vehicle.wheeled.emplace();
  wheeled.track_m = kTrack_m;
  wheeled.wheel_base_m = kFront_m + kRear_m;
  wheeled.wheel_radius_m = kRadius_m;
  wheeled.effective_track_m = effective * kTrack_m;
  for (const double x : {kFront_m, -kRear_m}) {
    for (const double y : {0.5 * kTrack_m, -0.5 * kTrack_m}) {
      wheeled.wheels.push_back({static_cast<int>(vehicle.actuators.size()), {x, y}});
      vehicle.actuators.push_back({"wheel_speed_radps", "rad/s", -20.0, 20.0});
    }
  }
  return vehicle;
}

/// Angles and speeds of wheels that roll in a rigid motion: each hub has the velocity
/// v + w x r, and a wheel rolls along it.
std::vector<double> rolling(Steering steering, const Eigen::Vector2d& v_mps,
                            double yaw_rate_radps) {
  const auto hub = [&](double x, double y) {
    return Eigen::Vector2d(v_mps.x() - yaw_rate_radps * y, v_mps.y() + yaw_rate_radps * x);
  };
  std::vector<double> actuators;
  const auto add_axle = [&](double x) {
    actuators.push_back(std::atan2(hub(x, 0.0).y(), hub(x, 0.0).x()));
  };
  if (steering != Steering::kSkid) add_axle(kFront_m);
  if (steering == Steering::kBoth) add_axle(-kRear_m);
  for (const double x : {kFront_m, -kRear_m}) {
    for (const double y : {0.5 * kTrack_m, -0.5 * kTrack_m}) {
      const Eigen::Vector2d v = hub(x, y);
      actuators.push_back((steering == Steering::kSkid ? v.x() : v.norm()) / kRadius_m);
    }
  }
  return actuators;
}

PlanarTwist solve(Steering steering, const std::vector<double>& actuators, double effective = 0.0) {
  const WheelMotion motion(make_vehicle(steering, effective), "rover.sensors.s");
  return motion.solve(actuators, std::vector<double>(4, kRadius_m), 1.0);
}

TEST(WheelMotion, FindsAnyMotionOfFourSteeredWheels) {
  for (const double yaw_rate : {-0.6, 0.0, 0.4}) {
    for (const double sideways : {-0.3, 0.0, 0.5}) {
      const PlanarTwist twist =
          solve(Steering::kBoth, rolling(Steering::kBoth, {1.2, sideways}, yaw_rate));
      EXPECT_NEAR(twist.v_mps.x(), 1.2, 1e-12);
      EXPECT_NEAR(twist.v_mps.y(), sideways, 1e-12);
      EXPECT_NEAR(twist.yaw_rate_radps, yaw_rate, 1e-12);
    }
  }
}

TEST(WheelMotion, TheRearAxleOfACarMovesStraightAhead) {
  const double yaw_rate = 0.5;
  const Eigen::Vector2d v_mps(1.5, yaw_rate * kRear_m);
  const PlanarTwist twist = solve(Steering::kFront, rolling(Steering::kFront, v_mps, yaw_rate));
  EXPECT_LT((twist.v_mps - v_mps).norm(), 1e-12);
  EXPECT_NEAR(twist.yaw_rate_radps, yaw_rate, 1e-12);
}

TEST(WheelMotion, SkidSteeringTurnsOnItsEffectiveTrack) {
  const std::vector<double> actuators = rolling(Steering::kSkid, {0.8, 0.0}, 0.9);
  PlanarTwist twist = solve(Steering::kSkid, actuators);
  EXPECT_NEAR(twist.v_mps.x(), 0.8, 1e-12);
  EXPECT_NEAR(twist.yaw_rate_radps, 0.9, 1e-12);
  twist = solve(Steering::kSkid, actuators, 1.5);
  EXPECT_NEAR(twist.v_mps.x(), 0.8, 1e-12);
  EXPECT_NEAR(twist.yaw_rate_radps, 0.6, 1e-12);
}

TEST(WheelMotion, StatesTheSpreadOfItsReadings) {
  constexpr double kAngle_rad = 0.002, kSpeed_radps = 0.05;
  constexpr int kDraws = 20'000;
  for (const Steering steering : {Steering::kSkid, Steering::kFront, Steering::kBoth}) {
    const VehicleDescription vehicle = make_vehicle(steering, 1.3);
    const WheelMotion motion(vehicle, "rover.sensors.s");
    const std::vector<double> radii_m(4, kRadius_m);
    const double yaw_rate = 0.4;
    const std::vector<double> exact =
        rolling(steering, {1.2, steering == Steering::kFront ? yaw_rate * kRear_m : 0.0}, yaw_rate);
    const PlanarTwist mean = motion.solve(exact, radii_m, 1.0);
    std::vector<double> stds, scratch;
    for (const ActuatorSpec& actuator : vehicle.actuators) {
      stds.push_back(actuator.unit == "rad" ? kAngle_rad : kSpeed_radps);
    }
    RandomStream random(1, "rover", "draws");
    double speed = 0.0, rate = 0.0;
    for (int k = 0; k < kDraws; ++k) {
      std::vector<double> read = exact;
      for (std::size_t i = 0; i < read.size(); ++i) {
        read[i] += stds[i] * random.normal();
      }
      const PlanarTwist twist = motion.solve(read, radii_m, 1.0);
      speed += std::pow(twist.v_mps.x() - mean.v_mps.x(), 2) / kDraws;
      rate += std::pow(twist.yaw_rate_radps - mean.yaw_rate_radps, 2) / kDraws;
    }
    const Eigen::Vector2d stated = motion.calc_std(exact, stds, scratch);
    // Five standard errors of a standard deviation: 1 / sqrt(2 n).
    EXPECT_NEAR(std::sqrt(speed) / stated[0], 1.0, 5.0 / std::sqrt(2.0 * kDraws));
    EXPECT_NEAR(std::sqrt(rate) / stated[1], 1.0, 5.0 / std::sqrt(2.0 * kDraws));
  }
}

struct Drive {
  explicit Drive(const test::SensorValues& values, std::uint64_t seed = 1) {
    bench.vehicle.description_ = make_vehicle(Steering::kSkid);
    bench.vehicle.states = std::vector<double>(4, 0.0);
    sensor = make_wheel_odometry(test::sensor_parameters("wheel_odometry", values),
                                 bench.context(1.0 / kPeriod_s, seed));
    bench.connect(*sensor);
    reading = bench.bus.subscribe<DeadReckoning>("rover/s", "test");
    exact = bench.bus.subscribe<DeadReckoning>("rover/s_truth", "test");
  }
  void tick() {
    bench.truth.write(now, truth);
    sensor->step(now);
    now = now + Duration{20'000'000};
  }

  SensorBench bench;
  std::unique_ptr<Sensor> sensor;
  SignalReader<DeadReckoning> reading, exact;
  Odometry truth;
  Time now;
};

TEST(WheelOdometry, ACircleClosesFromAnyStart) {
  Drive drive(kIdeal);
  drive.truth.X_WB = {quaternion_from_rpy({0.0, 0.0, 2.0}), {30.0, -7.0, 1.4}};
  const double speed_mps = 1.0;
  constexpr int kTicks = 500;
  const double yaw_rate = 2.0 * std::numbers::pi / (kTicks * kPeriod_s);
  drive.bench.vehicle.states = rolling(Steering::kSkid, {speed_mps, 0.0}, yaw_rate);
  drive.tick();
  EXPECT_LT(drive.reading.value().X_OB.p.norm(), 1e-12) << "the start is the origin";
  EXPECT_LT(drive.exact.value().X_OB.p.norm(), 1e-12);
  for (int i = 0; i < kTicks / 2; ++i) drive.tick();
  // Half way it is a diameter to the left.
  const double diameter_m = 2.0 * speed_mps / yaw_rate;
  EXPECT_LT((drive.reading.value().X_OB.p - Eigen::Vector3d(0, diameter_m, 0)).norm(), 1e-9);
  EXPECT_NEAR(drive.reading.value().v_OB_B.x(), speed_mps, 1e-12);
  EXPECT_NEAR(drive.reading.value().w_OB_B.z(), yaw_rate, 1e-12);
  for (int i = 0; i < kTicks / 2; ++i) drive.tick();
  EXPECT_LT(drive.reading.value().X_OB.p.norm(), 1e-9);
  EXPECT_NEAR(drive.reading.value().velocity_std_mps.norm(), 0.0, 1e-15) << "no errors";
}

TEST(WheelOdometry, TheTruthIsRelativeToTheLevelFrameOfTheStart) {
  Drive drive(kIdeal);
  drive.truth.X_WB = {quaternion_from_rpy({0.1, 0.0, 0.5}), {3.0, 4.0, 1.0}};
  drive.tick();
  const Eigen::Vector3d ahead(std::cos(0.5), std::sin(0.5), 0.0);
  drive.truth.X_WB.p += 2.0 * ahead + Eigen::Vector3d(0, 0, 0.3);
  drive.tick();
  const Pose& X_OB = drive.exact.value().X_OB;
  EXPECT_LT((X_OB.p - Eigen::Vector3d(2.0, 0.0, 0.3)).norm(), 1e-12);
  EXPECT_LT(X_OB.q.angularDistance(quaternion_from_rpy({0.1, 0.0, 0.0})), 1e-12);
}

TEST(WheelOdometry, ReckonsOnWhileItsReadingsAreLost) {
  Drive drive([] {
    test::SensorValues values = kIdeal;
    values.push_back({"dropout_share", 0.5});
    return values;
  }());
  drive.bench.vehicle.states = std::vector<double>(4, 1.0 / kRadius_m);
  for (int i = 0; i <= 100; ++i) drive.tick();
  const double measured_s = (drive.bench.bus.find("rover/s")->stamp() - Time{}).s();
  EXPECT_GT(measured_s, 1.5);
  EXPECT_NEAR(drive.reading.value().X_OB.p.x(), measured_s, 1e-9);
}

TEST(WheelOdometry, StatesTheSpreadOfVelocityAndYawRate) {
  test::SensorValues values = kIdeal;
  for (auto& [name, value] : values) {
    if (name == "speed_noise_std_radps") value = 0.05;
  }
  Drive drive(values);
  drive.tick();
  // The mean of four rims; the difference of the sides over their distance.
  const double rim_std_mps = 0.05 * kRadius_m;
  EXPECT_NEAR(drive.reading.value().velocity_std_mps.x(), 0.5 * rim_std_mps, 1e-9);
  EXPECT_NEAR(drive.reading.value().yaw_rate_std_radps, rim_std_mps / kTrack_m, 1e-9);
  EXPECT_EQ(drive.exact.value().yaw_rate_std_radps, 0.0);
}

TEST(WheelOdometry, DrawsUnequalWheelsOncePerRun) {
  test::SensorValues values = kIdeal;
  for (auto& [name, value] : values) {
    if (name == "radius_error_std") value = 0.01;
  }
  constexpr int kRuns = 2'000;
  double speed = 0.0, yaw = 0.0;
  for (int seed = 0; seed < kRuns; ++seed) {
    Drive drive(values, static_cast<std::uint64_t>(seed));
    drive.bench.vehicle.states = std::vector<double>(4, 1.0 / kRadius_m);
    drive.tick();
    const DeadReckoning first = drive.reading.value();
    drive.tick();
    EXPECT_EQ(drive.reading.value().w_OB_B.z(), first.w_OB_B.z()) << "once";
    speed += std::pow(first.v_OB_B.x() - 1.0, 2) / kRuns;
    yaw += std::pow(first.w_OB_B.z(), 2) / kRuns;
  }
  // Four rims of 1 m/s, each 1 % off: the mean by 0.5 %; the yaw rate, the difference of two means
  // of two over the track, by 1 % / track.
  EXPECT_NEAR(std::sqrt(speed) / 0.005, 1.0, 5.0 / std::sqrt(2.0 * kRuns));
  EXPECT_NEAR(std::sqrt(yaw) / (0.01 / kTrack_m), 1.0, 5.0 / std::sqrt(2.0 * kRuns));
}

std::string refusal(const VehicleDescription& vehicle, std::size_t states) {
  SensorBench bench;
  bench.vehicle.description_ = vehicle;
  bench.vehicle.states = std::vector<double>(states, 0.0);
  try {
    make_wheel_odometry(test::sensor_parameters("wheel_odometry", {}), bench.context(50.0));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(WheelOdometry, RefusesVehiclesWhoseWheelsAreUnknown) {
  VehicleDescription drone;
  drone.type = "drone";
  drone.rotorcraft.emplace();
  EXPECT_EQ(refusal(drone, 4),
            "rover.sensors.s needs a vehicle with wheels; vehicle type 'drone' has rotors");
  VehicleDescription blind = make_vehicle(Steering::kSkid);
  blind.wheeled->wheels.clear();
  EXPECT_EQ(refusal(blind, 4),
            "rover.sensors.s: vehicle type 'fixed' does not state where its wheels are");
  EXPECT_EQ(refusal(make_vehicle(Steering::kSkid), 0),
            "rover.sensors.s: wheel odometry needs the states of the actuators, which vehicle type "
            "'fixed' does not have");
  VehicleDescription one_sided = make_vehicle(Steering::kSkid);
  for (WheelPlace& wheel : one_sided.wheeled->wheels) wheel.p_B.y() = 0.4;
  EXPECT_EQ(refusal(one_sided, 4),
            "rover.sensors.s: the driven wheels of vehicle type 'fixed' are all on one side, so "
            "their speeds do not show its turning");
}

}  // namespace
}  // namespace vinerow::sensors::wheel_odometry_test
