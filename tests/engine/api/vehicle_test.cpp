#include "engine/api/vehicle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "engine/api/vehicle_check.h"
#include "engine/core/error.h"

namespace vinerow::vehicle_test {
namespace {

/// Has the given mass and no air loads.
class StillModel final : public FlightModel {
 public:
  explicit StillModel(double mass_kg) : mass_kg_(mass_kg) {}
  AirLoad load(const AirPoint&, std::span<const double>) const override { return {}; }
  double mass_kg() const override { return mass_kg_; }
  Eigen::Matrix3d inertia_B() const override { return Eigen::Matrix3d::Identity(); }

 private:
  double mass_kg_;
};

VehicleDescription make_rover() {
  VehicleDescription rover;
  rover.type = "straddler";
  rover.actuators = {{"axle_front_steer_rad", "rad", -0.4, 0.4},
                     {"axle_rear_steer_rad", "rad", -0.4, 0.4},
                     {"wheel_left_speed_radps", "rad/s", -8.0, 8.0},
                     {"wheel_right_speed_radps", "rad/s", -8.0, 8.0}};
  rover.mass_kg = 300.0;
  rover.collision_half_extents_m = {0.95, 0.5, 0.2};
  rover.height_above_ground_m = 0.4;
  rover.max_speed_mps = 1.6;
  rover.min_turning_radius_m = 1.8;
  rover.wheeled = {
      .track_m = 0.85, .wheel_base_m = 1.5, .wheel_radius_m = 0.2, .wheel_speed_limit_radps = 8.0};
  rover.steered = {.front_axle_m = 0.75,
                   .rear_axle_m = 0.75,
                   .max_axle_steer_rad = 0.4,
                   .steer_rate_radps = 2.0};
  return rover;
}

VehicleDescription make_drone() {
  VehicleDescription drone;
  drone.type = "hexarotor";
  drone.mass_kg = 2.0;
  drone.height_above_ground_m = 0.2;
  Rotorcraft& craft = drone.rotorcraft.emplace();
  craft.rotors = {{{0.2, 0.2}, 1.0}, {{-0.2, -0.2}, -1.0}};
  for (const char* name : {"rotor_1_speed_radps", "rotor_2_speed_radps"}) {
    drone.actuators.push_back({name, "rad/s", 0.0, 640.0});
  }
  craft.inertia_kgm2 = {0.05, 0.05, 0.1};
  craft.thrust_coefficient_Ns2 = 6e-5;
  craft.torque_coefficient_Nms2 = 1e-6;
  craft.max_rotor_radps = 640.0;
  craft.rotor_radius_m = 0.15;
  craft.max_tilt_rad = 0.4;
  craft.landing_speed_limit_mps = 1.0;
  return drone;
}

VehicleDescription make_plane() {
  VehicleDescription plane;
  plane.type = "delta";
  plane.mass_kg = 1.2;
  plane.height_above_ground_m = 0.1;
  plane.actuators = {{"throttle", "", 0.0, 1.0},
                     {"elevon_left_rad", "rad", -0.4, 0.4},
                     {"elevon_right_rad", "rad", -0.4, 0.4}};
  FixedWingAircraft& aircraft = plane.fixed_wing.emplace();
  aircraft.flight_model = std::make_shared<StillModel>(1.2);
  aircraft.span_m = 0.9;
  aircraft.cruise_speed_mps = 12.0;
  aircraft.stall_speed_mps = 8.4;
  aircraft.max_bank_rad = 0.7;
  aircraft.landing_sink_limit_mps = 2.0;
  return plane;
}

std::string complaint(const std::function<void()>& ask) {
  try {
    ask();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(VehicleKinds, AreHandedOutWhereTheyAreThere) {
  const VehicleDescription rover = make_rover(), drone = make_drone(), plane = make_plane();
  EXPECT_EQ(&rover.need_wheeled("me"), &*rover.wheeled);
  EXPECT_EQ(&rover.need_steered("me"), &*rover.steered);
  EXPECT_EQ(&drone.need_rotorcraft("me"), &*drone.rotorcraft);
  EXPECT_EQ(&plane.need_fixed_wing("me"), &*plane.fixed_wing);
  EXPECT_FALSE(rover.flies());
  EXPECT_TRUE(drone.flies());
  EXPECT_TRUE(plane.flies());
}

TEST(VehicleKinds, AreMissedInOneSentence) {
  const std::string who = "a.controller (b)";
  EXPECT_EQ(complaint([&] { make_drone().need_wheeled(who); }),
            "a.controller (b) needs a vehicle with wheels; vehicle type 'hexarotor' has rotors");
  EXPECT_EQ(complaint([&] { make_plane().need_steered(who); }),
            "a.controller (b) needs a vehicle with two steered axles; vehicle type 'delta' has "
            "wings");
  EXPECT_EQ(complaint([&] { make_rover().need_ackermann(who); }),
            "a.controller (b) needs a vehicle with a steered front axle; vehicle type 'straddler' "
            "has wheels and two steered axles");
  EXPECT_EQ(complaint([&] { make_rover().need_rotorcraft(who); }),
            "a.controller (b) needs a vehicle with rotors; vehicle type 'straddler' has wheels and "
            "two steered axles");
  VehicleDescription tiltrotor = make_drone();
  tiltrotor.wheeled.emplace();
  tiltrotor.steered.emplace();
  EXPECT_EQ(complaint([&] { tiltrotor.need_fixed_wing(who); }),
            "a.controller (b) needs a vehicle with wings; vehicle type 'hexarotor' has wheels, "
            "two steered axles and rotors");
  VehicleDescription box;
  box.type = "box";
  EXPECT_EQ(complaint([&] { box.need_fixed_wing(who); }),
            "a.controller (b) needs a vehicle with wings; vehicle type 'box' has neither wheels "
            "nor rotors nor wings");
}

TEST(VehicleKinds, NumbersThatAreMissingOrNotPositiveAreSaid) {
  VehicleDescription rover = make_rover();
  EXPECT_EQ(rover.need(rover.max_speed_mps, "max_speed_mps", "me"), 1.6);
  EXPECT_EQ(complaint([&] { rover.need(rover.battery_capacity_J, "battery_capacity_J", "me"); }),
            "me needs 'battery_capacity_J', which vehicle type 'straddler' does not have");
  EXPECT_EQ(rover.need_positive(0.85, "track_m", "me"), 0.85);
  EXPECT_EQ(complaint([&] { rover.need_positive(-0.85, "track_m", "me"); }),
            "me needs 'track_m' > 0, but vehicle type 'straddler' has -0.85");
  EXPECT_EQ(complaint([&] { rover.need_positive(std::nan(""), "track_m", "me"); }),
            "me needs 'track_m' > 0, but vehicle type 'straddler' has nan");
}

TEST(VehicleCheck, FindsNoFaultInWholeDescriptions) {
  for (const VehicleDescription& vehicle : {make_rover(), make_drone(), make_plane()}) {
    EXPECT_EQ(find_fault(vehicle).value_or("none"), "none") << vehicle.type;
  }
}

using Change = std::function<void(VehicleDescription&)>;

std::string fault(VehicleDescription vehicle, const Change& change) {
  change(vehicle);
  return find_fault(vehicle).value_or("none");
}

TEST(VehicleCheck, SaysWhatIsWrongWithAnyVehicle) {
  using V = VehicleDescription;
  const V rover = make_rover();
  EXPECT_EQ(fault(rover, [](V& v) { v.type.clear(); }), "type is empty");
  EXPECT_EQ(fault(rover, [](V& v) { v.mass_kg = std::nan(""); }), "mass_kg = nan, must be > 0");
  EXPECT_EQ(fault(rover, [](V& v) { v.collision_half_extents_m.y() = 0.0; }),
            "an entry of collision_half_extents_m = 0, must be > 0");
  EXPECT_EQ(fault(rover, [](V& v) { v.max_speed_mps = 0.0; }), "max_speed_mps = 0, must be > 0");
  EXPECT_EQ(fault(rover, [](V& v) { v.min_turning_radius_m = -1.0; }),
            "min_turning_radius_m = -1, must be >= 0");
  EXPECT_EQ(fault(rover, [](V& v) { v.actuators.clear(); }), "it has no actuators");
  EXPECT_EQ(fault(rover, [](V& v) { v.actuators[3].name = v.actuators[2].name; }),
            "two actuators are called 'wheel_left_speed_radps'");
  EXPECT_EQ(fault(rover, [](V& v) { v.actuators[2].min = 9.0; }),
            "actuator 'wheel_left_speed_radps' has min = 9, must be finite and < max = 8");
  EXPECT_EQ(fault(rover, [](V& v) { v.wheeled.reset(), v.steered.reset(); }),
            "none of wheeled, rotorcraft and fixed_wing is given");
  EXPECT_EQ(fault(make_drone(), [&](V& v) { v.steered = make_rover().steered; }),
            "steered is given without wheeled");
}

TEST(VehicleCheck, SaysWhatIsWrongWithWheelsAndAxles) {
  using V = VehicleDescription;
  const V rover = make_rover();
  EXPECT_EQ(fault(rover, [](V& v) { v.wheeled->track_m = 0.0; }),
            "wheeled.track_m = 0, must be > 0");
  EXPECT_EQ(fault(rover, [](V& v) { v.wheeled->effective_track_m = -1.0; }),
            "wheeled.effective_track_m = -1, must be >= 0");
  EXPECT_EQ(fault(rover,
                  [](V& v) {
                    v.wheeled->wheels = {{99, {0.0, 0.4}}};
                  }),
            "wheeled.wheels has a wheel of actuator 99, which is not a speed in rad/s");
  EXPECT_EQ(fault(rover,
                  [](V& v) {
                    v.wheeled->wheels = {{0, {0.0, 0.4}}};
                  }),
            "wheeled.wheels has a wheel of actuator 0, which is not a speed in rad/s");
  EXPECT_EQ(fault(rover, [](V& v) { v.wheeled->track_m = 1.2; }),
            "the outline of 1.9 x 1 m does not contain the wheels, 1.5 m apart along and 1.2 m "
            "across");
  EXPECT_EQ(fault(rover, [](V& v) { v.height_above_ground_m = 0.1; }),
            "the collision box reaches 0.1 m into level ground");
  EXPECT_EQ(fault(rover, [](V& v) { v.steered->max_axle_steer_rad = 1.6; }),
            "steered.max_axle_steer_rad = 1.6, must be > 0 and < pi/2");
  EXPECT_EQ(fault(rover, [](V& v) { v.steered->rear_axle_m = 0.5; }),
            "steered's axles are 1.25 m apart, wheeled.wheel_base_m = 1.5");
  EXPECT_EQ(fault(rover, [](V& v) { v.actuators[0].name = "tiller_rad"; }),
            "steered is given, but there is no actuator 'axle_front_steer_rad'");
}

TEST(VehicleCheck, SaysWhatIsWrongWithASteeredFrontAxle) {
  using V = VehicleDescription;
  V car = make_rover();
  car.steered.reset();
  std::erase_if(car.actuators, [](const auto& one) { return one.name == "axle_rear_steer_rad"; });
  car.ackermann = {.rear_axle_m = 0.6, .max_axle_steer_rad = 0.4, .steer_rate_radps = 2.0};
  EXPECT_EQ(find_fault(car).value_or("none"), "none");
  EXPECT_TRUE(car.steers_by_axles());
  EXPECT_EQ(fault(car, [](V& v) { v.wheeled.reset(), v.rotorcraft = make_drone().rotorcraft; }),
            "ackermann is given without wheeled");
  EXPECT_EQ(fault(car, [](V& v) { v.steered = make_rover().steered; }),
            "ackermann and steered are both given");
  EXPECT_EQ(fault(car, [](V& v) { v.ackermann->rear_axle_m = 1.5; }),
            "ackermann.rear_axle_m = 1.5 puts the front axle behind B's origin; "
            "wheeled.wheel_base_m = 1.5");
  EXPECT_EQ(fault(car, [](V& v) { v.actuators[0].name = "tiller_rad"; }),
            "ackermann is given, but there is no actuator 'axle_front_steer_rad'");
}

TEST(VehicleCheck, SaysWhatIsWrongWithRotors) {
  using V = VehicleDescription;
  const V drone = make_drone();
  EXPECT_EQ(fault(drone, [](V& v) { v.rotorcraft->rotors.clear(); }), "rotorcraft.rotors is empty");
  EXPECT_EQ(fault(drone, [](V& v) { v.rotorcraft->inertia_kgm2.z() = 0.0; }),
            "an entry of rotorcraft.inertia_kgm2 = 0, must be > 0");
  EXPECT_EQ(fault(drone, [](V& v) { v.rotorcraft->min_rotor_radps = 700.0; }),
            "rotorcraft.max_rotor_radps = 640, must be > min_rotor_radps = 700");
  EXPECT_EQ(fault(drone, [](V& v) { v.rotorcraft->rotors[1].torque_sign = 0.5; }),
            "rotorcraft.rotors[1].torque_sign = 0.5, must be 1 or -1");
  EXPECT_EQ(fault(drone, [](V& v) { v.rotorcraft->tip_radius_m = 0.3; }),
            "rotorcraft.rotors[0] reaches 0.432843 m from B's z axis, rotorcraft.tip_radius_m = "
            "0.3");
  EXPECT_EQ(fault(drone, [](V& v) { v.actuators.pop_back(); }),
            "rotorcraft is given, but there is no actuator 'rotor_2_speed_radps'");
}

TEST(VehicleCheck, SaysWhatIsWrongWithWings) {
  using V = VehicleDescription;
  const V plane = make_plane();
  EXPECT_EQ(fault(plane, [](V& v) { v.fixed_wing->flight_model = nullptr; }),
            "fixed_wing.flight_model is null");
  EXPECT_EQ(fault(plane, [](V& v) { v.mass_kg = 1.5; }),
            "fixed_wing.flight_model weighs 1.2 kg, mass_kg = 1.5");
  EXPECT_EQ(fault(plane, [](V& v) { v.fixed_wing->stall_speed_mps = 13.0; }),
            "fixed_wing.cruise_speed_mps = 12, must be > stall_speed_mps = 13");
  EXPECT_EQ(fault(plane, [](V& v) { v.fixed_wing->launch_throttle = 1.0; }),
            "fixed_wing.launch_throttle = 1, must be >= 0 and < 1");
  EXPECT_EQ(
      fault(plane,
            [](V& v) { v.fixed_wing->start_height_m = std::numeric_limits<double>::infinity(); }),
      "fixed_wing.start_height_m = inf, must be > 0");
  EXPECT_EQ(fault(plane, [](V& v) { v.actuators[0].name = "power"; }),
            "fixed_wing is given, but there is no actuator 'throttle'");
}

}  // namespace
}  // namespace vinerow::vehicle_test
