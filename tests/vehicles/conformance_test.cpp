/// What every registered vehicle must do. A vehicle that needs parameters gets them in setups().
/// Vehicles on wheels drive, those on rotors and wings fly: each kind has requirements of its own.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "engine/api/messages/sensors.h"
#include "engine/api/vehicle_check.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/support/no_alloc.h"
#include "tests/support/paths.h"
#include "tests/vehicles/small_worlds.h"
#include "vehicles/register_vehicles.h"

namespace vinerow::vehicles::conformance_test {
namespace {

using namespace test;

struct Setup {
  std::string label;
  std::string type;
  std::function<void(ParameterSet&)> set;
};

std::vector<Setup> setups() {
  Registry registry;
  vehicles::register_vehicles(registry);
  std::vector<Setup> result;
  for (const std::string& name : registry.names(PartKind::kVehicle)) {
    if (name == "urdf_rover") {
      result.push_back({name, name, [](ParameterSet& set) {
                          set.set("urdf", std::string(VINEROW_SOURCE_DIR) +
                                              "/tests/vehicles/data/plain_rover.urdf");
                        }});
      result.push_back({name + "_car", name, [](ParameterSet& set) {
                          set.set("urdf", std::string(VINEROW_SOURCE_DIR) +
                                              "/tests/vehicles/data/plain_car.urdf");
                          // Motors and brakes of a machine of 200 kg, on two wheels alone.
                          set.set("max_torque_Nm", 150.0);
                          set.set("max_power_W", 2000.0);
                          set.set("speed_gain_Nms", 60.0);
                          set.set("speed_integral_gain_Nm", 300.0);
                          set.set("brake_torque_Nm", 200.0);
                        }});
      result.push_back({name + "_four_steered", name, [](ParameterSet& set) {
                          set.set("urdf", std::string(VINEROW_SOURCE_DIR) +
                                              "/tests/vehicles/data/plain_four_steered.urdf");
                        }});
      continue;
    }
    result.push_back({name, name, [](ParameterSet&) {}});
    if (name == "four_wheel_steering_rover") {
      result.push_back({name + "_wheel_limit", name,
                        [](ParameterSet& set) { set.set("steer_limit", std::string("wheel")); }});
    }
    if (name == "quadrotor") {
      result.push_back({name + "_plus", name,
                        [](ParameterSet& set) { set.set("layout", std::string("plus")); }});
    }
    if (name == "fixed_wing") {
      result.push_back({name + "_catapult", name,
                        [](ParameterSet& set) { set.set("launch", std::string("catapult")); }});
    }
    if (name == "diff_drive_rover") {
      result.push_back({name + "_kinematic", name,
                        [](ParameterSet& set) { set.set("fidelity", std::string("kinematic")); }});
    }
  }
  return result;
}

/// A vehicle in a world of its own, driven by speeds of its sides, flown by those of its rotors or
/// by throttle and elevons.
class Rig {
 public:
  Rig(const Setup& setup, WorldModel model, double yaw_rad = 0.0)
      : world_model_(std::move(model)), world_(physics::PhysicsSettings{}, world_model_) {
    Registry registry;
    vehicles::register_vehicles(registry);
    const PartSpec& spec = registry.spec(PartKind::kVehicle, setup.type);
    ParameterSet parameters(spec.parameters, setup.type);
    setup.set(parameters);
    parameters.require_complete();
    VehicleContext context;
    context.vehicle = "rover";
    context.part = "rover";
    vehicle_ = registry.make_vehicle(setup.type, parameters, context);
    const VehicleDescription& about = vehicle_->description();
    vehicle_->spawn(world_,
                    pose_on_ground(world_model_, 0.0, 0.0, yaw_rad, about.height_above_ground_m));
    Ports ports(bus_, "rover", "rover");
    vehicle_->connect(ports);
    values_.assign(about.actuators.size(), 0.0);
  }

  const VehicleDescription& about() const { return vehicle_->description(); }
  bool flies() const { return about().flies(); }
  bool has_wings() const { return about().fixed_wing.has_value(); }
  bool has_rotors() const { return about().rotorcraft.has_value(); }
  Vehicle& vehicle() { return *vehicle_; }
  SignalBus& bus() { return bus_; }

  /// All rotors at this speed, within their limits.
  void spin(double speed_radps) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      values_[i] = std::clamp(speed_radps, about().actuators[i].min, about().actuators[i].max);
    }
    vehicle_->actuate(values_);
  }
  /// At which the rotors carry the weight.
  double hover_radps() const {
    const Rotorcraft& craft = about().rotorcraft.value();
    return std::sqrt(about().mass_kg * 9.80665 / static_cast<double>(craft.rotors.size()) /
                     craft.thrust_coefficient_Ns2);
  }
  /// Of a vehicle on wings.
  void fly(double throttle, double elevon_left_rad, double elevon_right_rad) {
    values_ = {throttle, elevon_left_rad, elevon_right_rad};
    for (std::size_t i = 0; i < values_.size(); ++i) {
      values_[i] = std::clamp(values_[i], about().actuators[i].min, about().actuators[i].max);
    }
    vehicle_->actuate(values_);
  }
  /// A moderate command: about a metre per second, or a take-off.
  void move() {
    if (has_wings()) return fly(1.0, 0.0, 0.0);
    if (has_rotors()) return spin(1.1 * hover_radps());
    drive(1.0, 0.6);
  }
  void rest() {
    values_.assign(values_.size(), 0.0);
    vehicle_->actuate(values_);
  }

  /// Rim speeds of both sides, m/s. A vehicle that steers gets the same twist as a command: the yaw
  /// rate of two sides that roll on the track, within the limits of its steering.
  void drive(double left_mps, double right_mps) {
    const double radius = about().wheeled->wheel_radius_m;
    const bool steers = about().actuators[0].name == "axle_front_steer_rad";
    const double v = 0.5 * (left_mps + right_mps), track = about().wheeled->track_m;
    // The centre of the turn lies beside the rear axle of a car, else beside the middle.
    const double base = about().wheeled->wheel_base_m;
    const double rear_lever = about().ackermann ? 0.0 : 0.5 * base;
    const double front_lever = base - rear_lever;
    double curvature = 0.0;
    if (steers) {
      const double max_curvature = std::tan(about().actuators[0].max) / front_lever;
      const double wanted = (right_mps - left_mps) / track / (v == 0.0 ? 1e-9 : v);
      curvature = std::clamp(wanted, -max_curvature, max_curvature);
    }
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const ActuatorSpec& actuator = about().actuators[i];
      if (actuator.name == "axle_front_steer_rad") {
        values_[i] = std::atan(curvature * front_lever);
      } else if (actuator.name == "axle_rear_steer_rad") {
        values_[i] = -std::atan(curvature * rear_lever);
      } else {
        // "wheel_fl_...", "wheel_rl_...", "wheel_l1_...": the side's letter is the last before '_'
        // or the first with a number behind it.
        const std::string wheel = actuator.name.substr(6, 2);
        const bool left = wheel[1] == 'l' || (wheel[0] == 'l' && wheel[1] != 'r');
        double speed_mps = left ? left_mps : right_mps;
        if (steers) {
          const double lever = 1.0 - curvature * (left ? 0.5 : -0.5) * track;
          speed_mps =
              v * std::hypot(lever, curvature * (wheel[0] == 'f' ? front_lever : rear_lever));
        }
        values_[i] = speed_mps / radius;
      }
      values_[i] = std::clamp(values_[i], actuator.min, actuator.max);
    }
    vehicle_->actuate(values_);
  }
  void step() {
    vehicle_->before_physics(now_, dt_);
    world_.step(dt_);
    now_ = now_ + dt_;
    vehicle_->after_physics(now_, dt_);
  }
  void run(double time_s) {
    for (auto i = std::llround(time_s / dt_.s()); i > 0; --i) step();
  }
  Odometry truth() const {
    Odometry truth;
    vehicle_->read_truth(truth);
    return truth;
  }
  Time now() const { return now_; }
  /// What was last commanded.
  double command(std::size_t actuator) const { return values_[actuator]; }

 private:
  WorldModel world_model_;
  physics::PhysicsWorld world_;
  SignalBus bus_;
  std::unique_ptr<Vehicle> vehicle_;
  std::vector<double> values_;
  Time now_;
  Duration dt_{1'000'000};
};

class VehicleConformance : public ::testing::TestWithParam<Setup> {};
/// Requirements of one kind only.
class WheeledConformance : public VehicleConformance {};
class FlyingConformance : public VehicleConformance {};  // on rotors
class WingedConformance : public VehicleConformance {};

TEST_P(VehicleConformance, DescribesItselfCompletely) {
  Rig rig(GetParam(), make_flat_world());
  const VehicleDescription& about = rig.about();
  EXPECT_EQ(about.type, GetParam().type);
  EXPECT_EQ(find_fault(about).value_or("none"), "none");
  for (const ActuatorSpec& actuator : about.actuators) {
    if (actuator.name != "throttle") {  // a share
      EXPECT_FALSE(actuator.unit.empty()) << actuator.name;
    }
  }
  EXPECT_TRUE(about.max_speed_mps.has_value());
  EXPECT_TRUE(about.min_turning_radius_m.has_value());
  EXPECT_NE(about.flies(), about.wheeled.has_value());
  std::vector<Pose> poses(rig.vehicle().links().size());
  rig.vehicle().read_links(poses);
  ASSERT_FALSE(poses.empty());
  for (const VehicleLink& link : rig.vehicle().links()) {
    EXPECT_GT(link.mesh->triangles.size(), 0u) << link.name;
    EXPECT_EQ(link.mesh->normals.size(), link.mesh->vertices.size()) << link.name;
  }
}

TEST_P(VehicleConformance, StandsWhereItSays) {
  Rig rig(GetParam(), make_flat_world());
  // What has wings rests on its launcher.
  const double height =
      rig.has_wings() ? rig.truth().X_WB.p.z() : rig.about().height_above_ground_m;
  rig.run(1.0);
  EXPECT_NEAR(rig.truth().X_WB.p.z(), height, 1e-3);
  const Eigen::Vector3d up_B = rig.truth().X_WB.q.conjugate() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(rig.vehicle().specific_force_B().dot(up_B), 9.80665, 1e-3);
  EXPECT_TRUE(rig.vehicle().crash().empty());
}

TEST_P(WheeledConformance, StatesWhereItsDrivenWheelsAre) {
  Rig rig(GetParam(), make_flat_world());
  const VehicleDescription& about = rig.about();
  std::vector<int> driven;
  for (std::size_t i = 0; i < about.actuators.size(); ++i) {
    if (about.actuators[i].unit == "rad/s") driven.push_back(static_cast<int>(i));
  }
  std::vector<int> stated;
  double min_y = 1e9, max_y = -1e9;
  for (const WheelPlace& wheel : about.wheeled->wheels) {
    stated.push_back(wheel.actuator);
    min_y = std::min(min_y, wheel.p_B.y()), max_y = std::max(max_y, wheel.p_B.y());
    // The hub is where the wheel's link is drawn.
    const std::string& name = about.actuators[static_cast<std::size_t>(wheel.actuator)].name;
    const std::string link = name.substr(0, name.find("_speed_radps"));
    std::vector<Pose> poses(rig.vehicle().links().size());
    rig.vehicle().read_links(poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (rig.vehicle().links()[i].name != link) continue;
      const Eigen::Vector3d p_B = rig.truth().X_WB.inverse() * poses[i].p;
      EXPECT_LT((p_B.head<2>() - wheel.p_B).norm(), 0.02) << link;
    }
  }
  EXPECT_EQ(stated, driven);
  EXPECT_NEAR(max_y - min_y, about.wheeled->track_m, 1e-9);
}

TEST_P(WheeledConformance, ComesToRest) {
  Rig rig(GetParam(), make_flat_world());
  const double v = 0.5 * rig.about().max_speed_mps.value();
  rig.drive(v, v);
  rig.run(3.0);
  EXPECT_NEAR(rig.truth().v_WB_B.x(), v, 0.05 * v);  // slip under rolling resistance is below 1 %
  rig.drive(0.0, 0.0);
  rig.run(4.0);
  EXPECT_LT(rig.truth().v_WB_B.norm(), 1e-4);
  EXPECT_LT(rig.truth().w_WB_B.norm(), 1e-4);
}

TEST_P(VehicleConformance, RestsOnASlopeForAMinute) {
  for (const double yaw_deg : {0.0, 35.0, 90.0}) {
    Rig rig(GetParam(), make_slope_world(rad_from_deg(18.0)), rad_from_deg(yaw_deg));
    rig.rest();
    rig.run(3.0);  // to settle on its springs
    const Eigen::Vector3d start = rig.truth().X_WB.p;
    rig.run(60.0);
    EXPECT_LT((rig.truth().X_WB.p - start).norm(), 1e-4) << "heading " << yaw_deg << " deg";
  }
}

TEST_P(WheeledConformance, RestsOnASlopeFromTheFirstStepOn) {
  for (const double yaw_deg : {0.0, 35.0, 90.0}) {
    Rig rig(GetParam(), make_slope_world(rad_from_deg(18.0)), rad_from_deg(yaw_deg));
    const Eigen::Vector3d start = rig.truth().X_WB.p;
    double moved_m = 0.0;
    for (int i = 0; i < 100; ++i) {
      rig.run(0.01);
      moved_m = std::max(moved_m, (rig.truth().X_WB.p - start).norm());
    }
    EXPECT_LT(moved_m, 1e-4) << "heading " << yaw_deg << " deg";
  }
}

TEST_P(WheeledConformance, StartsOnASlopeWithoutRollingBack) {
  for (const double yaw_deg : {0.0, 180.0}) {  // one is uphill
    Rig rig(GetParam(), make_slope_world(rad_from_deg(14.0)), rad_from_deg(yaw_deg));
    const Pose start = rig.truth().X_WB;  // parked there
    double back_m = 0.0;
    for (int i = 0; i < 300; ++i) {
      rig.drive(0.1, 0.1);
      rig.run(0.01);
      back_m = std::min(back_m, (start.inverse() * rig.truth().X_WB).p.x());
    }
    EXPECT_GT(back_m, -0.003) << "heading " << yaw_deg << " deg";
    EXPECT_GT((start.inverse() * rig.truth().X_WB).p.x(), 0.1) << "heading " << yaw_deg << " deg";
  }
}

TEST_P(WheeledConformance, DrivesStraight) {
  Rig rig(GetParam(), make_flat_world());
  const double v = rig.about().max_speed_mps.value();
  rig.drive(v, v);
  rig.run(10.0);
  const Pose pose = rig.truth().X_WB;
  EXPECT_GT(pose.p.x(), 9.0 * v);
  EXPECT_LE(pose.p.x(), 10.0 * v * (1.0 + 1e-12));
  // A centre of mass a little off the middle may bend the way a little: 0.1 % of it.
  EXPECT_LT(std::abs(pose.p.y()), 1e-3 * pose.p.x());
}

TEST_P(WheeledConformance, TurnsLeftForAPositiveYawCommand) {
  Rig rig(GetParam(), make_flat_world());
  const double v = 0.5 * rig.about().max_speed_mps.value();
  rig.drive(0.5 * v, 1.5 * v);
  rig.run(2.0);
  EXPECT_GT(rig.truth().w_WB_B.z(), 0.05);
  EXPECT_GT(rig.truth().X_WB.p.y(), 0.0);
  // Never more than rolling without side slip would give.
  EXPECT_LE(rig.truth().w_WB_B.z(), v / rig.about().wheeled->track_m + 1e-9);
}

TEST_P(WheeledConformance, ReversesTheWayItCame) {
  Rig rig(GetParam(), make_flat_world());
  const double v = 0.5 * rig.about().max_speed_mps.value();
  rig.drive(-v, -v);
  rig.run(3.0);
  EXPECT_LT(rig.truth().X_WB.p.x(), -2.0 * v);
}

TEST_P(VehicleConformance, SameInputsGiveTheSameBits) {
  const auto end = [&] {
    Rig rig(GetParam(), make_world(60.0, 0.5, [](double x, double y) {
              return 0.2 * std::sin(0.8 * x) * std::cos(0.6 * y);
            }));
    RandomStream random(7, "rover", "commands");
    const double v = rig.about().max_speed_mps.value();
    for (int i = 0; i < 20; ++i) {
      if (rig.has_wings()) {
        rig.fly(random.uniform(0.5, 1.0), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
      } else if (rig.has_rotors()) {
        rig.spin(rig.hover_radps() * random.uniform(0.9, 1.2));
      } else {
        rig.drive(random.uniform(-v, v), random.uniform(-v, v));
      }
      rig.run(0.2);
    }
    return rig.truth();
  };
  const Odometry first = end(), second = end();
  EXPECT_EQ(first.X_WB.p, second.X_WB.p);
  EXPECT_EQ(first.X_WB.q.coeffs(), second.X_WB.q.coeffs());
  EXPECT_EQ(first.v_WB_B, second.v_WB_B);
  EXPECT_EQ(first.w_WB_B, second.w_WB_B);
  EXPECT_TRUE(first.X_WB.p.allFinite());
}

TEST_P(VehicleConformance, AStepAllocatesNothing) {
  Rig rig(GetParam(), make_flat_world());
  rig.move();
  rig.run(rig.has_wings() ? 0.5 : 0.1);  // it has left its launcher
  std::vector<Pose> poses(rig.vehicle().links().size());
  rig.vehicle().publish(rig.now());  // the first write sizes the signals
  std::vector<double> values;
  for (const ActuatorSpec& actuator : rig.about().actuators) {
    values.push_back(std::min(1.0, actuator.max));
  }
  Odometry truth;
  const vinerow::test::AllocationCounter counter;
  for (int i = 0; i < 100; ++i) {
    rig.vehicle().actuate(values);
    rig.vehicle().before_physics(rig.now(), Duration{1'000'000});
    rig.vehicle().after_physics(rig.now(), Duration{1'000'000});
    rig.vehicle().read_truth(truth);
    rig.vehicle().read_links(poses);
    rig.vehicle().publish(rig.now());
  }
  EXPECT_EQ(counter.count(), 0u);
}

TEST_P(VehicleConformance, StaysFiniteAtItsActuatorLimitsOnRoughGround) {
  Rig rig(GetParam(), make_world(200.0, 0.4, [](double x, double y) {
            return 0.08 * std::sin(5.0 * x) * std::sin(4.0 * y) + 0.1 * x;
          }));
  for (int i = 0; i < 10; ++i) {
    if (rig.has_wings()) {
      rig.fly(i % 3 ? 1.0 : 0.0, i % 2 ? 1.0 : -1.0, i % 5 < 2 ? 1.0 : -1.0);
    } else if (rig.has_rotors()) {
      rig.spin(i % 2 ? 0.0 : 1e5);  // clamped to the limits; it falls on the ground and is wrecked
    } else {
      rig.drive(i % 2 ? 1e3 : -1e3, i % 3 ? 1e3 : -1e3);
    }
    rig.run(0.5);
    const Odometry truth = rig.truth();
    ASSERT_TRUE(truth.X_WB.p.allFinite() && truth.v_WB_B.allFinite());
    ASSERT_LT(truth.v_WB_B.norm(), rig.flies() ? 40.0 : 20.0);
  }
}

TEST_P(VehicleConformance, TellsTheStatesOfItsActuatorsOrNothing) {
  Rig rig(GetParam(), make_flat_world());
  if (rig.vehicle().actuator_states().empty()) GTEST_SKIP() << "tells no actuator states";
  const double v = 0.5 * rig.about().max_speed_mps.value();
  if (rig.flies()) {
    rig.move();
  } else {
    rig.drive(0.9 * v, 1.1 * v);
  }
  rig.run(3.0);
  const std::span<const double> states = rig.vehicle().actuator_states();
  ASSERT_EQ(states.size(), rig.about().actuators.size());
  // After three seconds each has come to its command: the servos to 0.01 rad, the motors to 2 %.
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double tolerance = rig.about().actuators[i].unit == "rad" ? 0.01 : 0.02 * rig.command(i);
    EXPECT_NEAR(states[i], rig.command(i), tolerance) << rig.about().actuators[i].name;
  }
}

TEST_P(VehicleConformance, PublishesEnergyThatGrows) {
  Rig rig(GetParam(), make_flat_world());
  const auto battery = rig.bus().subscribe<BatteryState>("rover/battery", "test");
  rig.move();
  rig.run(2.0);
  rig.vehicle().publish(rig.now());
  EXPECT_GT(battery.value().energy_used_J, 0.0);
  EXPECT_LT(battery.value().charge, 1.0);
  // What was used and what is left are the capacity, which metrics read from the description.
  EXPECT_NEAR(battery.value().charge * rig.about().battery_capacity_J.value() +
                  battery.value().energy_used_J,
              rig.about().battery_capacity_J.value(), 1e-6 * battery.value().energy_used_J);
}

TEST_P(WingedConformance, WaitsForItsThrottleThenFlies) {
  Rig rig(GetParam(), make_flat_world());
  const double needed = rig.about().fixed_wing->launch_throttle;
  const Eigen::Vector3d start = rig.truth().X_WB.p;
  rig.fly(needed, 0.1, 0.1);
  rig.run(1.0);
  EXPECT_EQ(rig.truth().X_WB.p, start);
  rig.fly(1.0, 0.0, 0.0);
  rig.run(1.5);
  EXPECT_GT(rig.truth().v_WB_B.x(), rig.about().fixed_wing->stall_speed_mps);
  EXPECT_GT(rig.truth().X_WB.p.x(), 10.0);
  EXPECT_GT(rig.truth().X_WB.p.z(), start.z());
  EXPECT_LT(std::abs(rig.truth().X_WB.p.y()), 1e-6);
  EXPECT_TRUE(rig.vehicle().crash().empty());
}

/// In calm air what it feels is its own motion.
TEST_P(WingedConformance, TellsItsVelocityThroughTheAir) {
  Rig rig(GetParam(), make_flat_world());
  rig.move();
  rig.run(1.0);
  EXPECT_LT((rig.vehicle().air_velocity_B() - rig.truth().v_WB_B).norm(), 1e-12);
}

TEST_P(WingedConformance, TellsAControllerHowItFlies) {
  Rig rig(GetParam(), make_flat_world());
  const VehicleDescription& about = rig.about();
  ASSERT_EQ(about.actuators.size(), 3u);
  EXPECT_EQ(about.actuators[0].name, "throttle");
  EXPECT_EQ(about.actuators[1].name, "elevon_left_rad");
  EXPECT_EQ(about.actuators[2].name, "elevon_right_rad");
  const FixedWingAircraft& aircraft = about.fixed_wing.value();
  EXPECT_GT(aircraft.throttle_lag_s, 0.0);
  EXPECT_GT(aircraft.elevon_lag_s, 0.0);
  EXPECT_GT(aircraft.launch_throttle, 0.0);
  EXPECT_GT(aircraft.belly_height_m, 0.0);
  EXPECT_GT(aircraft.cruise_speed_mps, aircraft.stall_speed_mps);
  ASSERT_NE(aircraft.flight_model, nullptr);
  const FlightModel& model = *aircraft.flight_model;
  EXPECT_EQ(model.mass_kg(), about.mass_kg);
  // More throttle pulls forward; elevons down pitch the nose down (+y of B), left down and right up
  // roll to the right (+x of B).
  AirPoint air;
  air.v_air_B = {aircraft.cruise_speed_mps, 0.0, -1.0};
  const auto load = [&](double throttle, double left_rad, double right_rad) {
    const std::array<double, 3> actuators = {throttle, left_rad, right_rad};
    return model.load(air, actuators);
  };
  EXPECT_GT(load(0.8, 0, 0).force_B.x(), load(0.5, 0, 0).force_B.x());
  EXPECT_GT(load(0.5, 0.1, 0.1).torque_B.y(), load(0.5, 0, 0).torque_B.y());
  EXPECT_GT(load(0.5, 0.1, -0.1).torque_B.x(), load(0.5, 0, 0).torque_B.x());
}

TEST_P(FlyingConformance, LiftsOffAtFullThrustAndKeepsLevel) {
  Rig rig(GetParam(), make_flat_world());
  rig.spin(1e5);
  rig.run(2.0);
  const Odometry truth = rig.truth();
  EXPECT_GT(truth.X_WB.p.z(), 5.0);
  EXPECT_LT(truth.X_WB.p.head<2>().norm(), 1e-3);
  EXPECT_GT((truth.X_WB.q * Eigen::Vector3d::UnitZ()).z(), 1.0 - 1e-6);
  EXPECT_LT(truth.w_WB_B.norm(), 1e-3);
  EXPECT_TRUE(rig.vehicle().crash().empty());
}

/// The hover speed in the description makes the vehicle hover: out of ground effect it keeps its
/// height.
TEST_P(FlyingConformance, HoversAtTheSpeedThatItsNumbersTell) {
  Rig rig(GetParam(), make_flat_world());
  rig.spin(1e5);
  rig.run(1.5);
  rig.spin(rig.hover_radps());
  rig.run(1.0);  // the rotors have come down; what is left of the climb is slowed by drag only
  const double before = rig.truth().v_WB_B.z();
  rig.run(0.5);
  EXPECT_GT(rig.truth().X_WB.p.z(), 5.0);
  EXPECT_LE(rig.truth().v_WB_B.z(), before);
  EXPECT_GT(rig.truth().v_WB_B.z(), 0.8 * before);
}

TEST_P(FlyingConformance, TellsAControllerWhereItsRotorsAre) {
  Rig rig(GetParam(), make_flat_world());
  const VehicleDescription& about = rig.about();
  const Rotorcraft& craft = about.rotorcraft.value();
  ASSERT_EQ(craft.rotors.size(), about.actuators.size());
  double torque = 0.0, tip = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < craft.rotors.size(); ++i) {
    EXPECT_EQ(about.actuators[i].name, "rotor_" + std::to_string(i + 1) + "_speed_radps");
    EXPECT_EQ(about.actuators[i].max, craft.max_rotor_radps);
    EXPECT_EQ(std::abs(craft.rotors[i].torque_sign), 1.0);
    torque += craft.rotors[i].torque_sign;
    sum += craft.rotors[i].p_B;
    tip = std::max(tip, craft.rotors[i].p_B.norm());
  }
  EXPECT_EQ(torque, 0.0);
  EXPECT_NEAR(sum.x(), 0.0, 1e-12);
  EXPECT_NEAR(sum.y(), 0.0, 1e-12);
  EXPECT_NEAR(craft.tip_radius_m, tip + craft.rotor_radius_m, 1e-12);
  EXPECT_GT(craft.torque_coefficient_Nms2, 0.0);
  EXPECT_GT(craft.rotor_lag_s, 0.0);
  EXPECT_GT(craft.inertia_kgm2.minCoeff(), 0.0);
  EXPECT_GT(craft.max_tilt_rad, 0.0);
}

std::vector<Setup> setups_that(const std::function<bool(const Rig&)>& fit) {
  std::vector<Setup> result;
  for (const Setup& setup : setups()) {
    if (fit(Rig(setup, make_flat_world()))) result.push_back(setup);
  }
  return result;
}

void PrintTo(const Setup& setup, std::ostream* out) {
  *out << setup.label;
}

const auto kLabel = [](const auto& setup) { return setup.param.label; };
INSTANTIATE_TEST_SUITE_P(Vehicles, VehicleConformance, ::testing::ValuesIn(setups()), kLabel);
INSTANTIATE_TEST_SUITE_P(
    Vehicles, WheeledConformance,
    ::testing::ValuesIn(setups_that([](const Rig& rig) { return !rig.flies(); })), kLabel);
INSTANTIATE_TEST_SUITE_P(
    Vehicles, FlyingConformance,
    ::testing::ValuesIn(setups_that([](const Rig& rig) { return rig.has_rotors(); })), kLabel);
INSTANTIATE_TEST_SUITE_P(
    Vehicles, WingedConformance,
    ::testing::ValuesIn(setups_that([](const Rig& rig) { return rig.has_wings(); })), kLabel);

}  // namespace
}  // namespace vinerow::vehicles::conformance_test
