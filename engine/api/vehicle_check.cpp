#include "engine/api/vehicle_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/math/angles.h"

namespace vinerow {
namespace {

/// Lengths that differ by less are equal but for rounding.
constexpr double kSame_m = 1e-9;

/// Keeps the first fault.
class Check {
 public:
  explicit Check(const VehicleDescription& vehicle) : vehicle_(vehicle) {}

  std::optional<std::string> run() {
    check_common();
    check_actuators();
    check_kinds();
    if (vehicle_.wheeled) check_wheeled(*vehicle_.wheeled);
    if (vehicle_.steered) check_steered(*vehicle_.steered);
    if (vehicle_.ackermann) check_ackermann(*vehicle_.ackermann);
    if (vehicle_.rotorcraft) check_rotorcraft(*vehicle_.rotorcraft);
    if (vehicle_.fixed_wing) check_fixed_wing(*vehicle_.fixed_wing);
    return fault_;
  }

 private:
  void demand(bool holds, const std::string& otherwise) {
    if (!holds && !fault_) fault_ = otherwise;
  }
  void positive(const std::string& name, double value) {
    demand(std::isfinite(value) && value > 0.0, fmt::format("{} = {:g}, must be > 0", name, value));
  }
  void not_negative(const std::string& name, double value) {
    demand(std::isfinite(value) && value >= 0.0,
           fmt::format("{} = {:g}, must be >= 0", name, value));
  }
  /// For angle limits that are meaningless from 90 deg on.
  void acute(const std::string& name, double value_rad) {
    demand(value_rad > 0.0 && value_rad < 0.5 * kPi,
           fmt::format("{} = {:g}, must be > 0 and < pi/2", name, value_rad));
  }
  void has_actuator(const std::string& record, const std::string& name) {
    const auto& all = vehicle_.actuators;
    demand(std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.name == name; }),
           fmt::format("{} is given, but there is no actuator '{}'", record, name));
  }

  void check_common() {
    demand(!vehicle_.type.empty(), "type is empty");
    positive("mass_kg", vehicle_.mass_kg);
    positive("height_above_ground_m", vehicle_.height_above_ground_m);
    demand(vehicle_.collision_centre_B.allFinite(), "collision_centre_B is not finite");
    for (const double half_m : vehicle_.collision_half_extents_m) {
      positive("an entry of collision_half_extents_m", half_m);
    }
    for (const Eigen::Vector2d& corner : vehicle_.footprint_B) {
      demand(corner.allFinite(), "a corner of footprint_B is not finite");
    }
    if (vehicle_.max_speed_mps) positive("max_speed_mps", *vehicle_.max_speed_mps);
    if (vehicle_.min_turning_radius_m) {
      not_negative("min_turning_radius_m", *vehicle_.min_turning_radius_m);
    }
    if (vehicle_.battery_capacity_J) positive("battery_capacity_J", *vehicle_.battery_capacity_J);
  }

  void check_actuators() {
    demand(!vehicle_.actuators.empty(), "it has no actuators");
    std::set<std::string> names;
    for (const ActuatorSpec& actuator : vehicle_.actuators) {
      demand(!actuator.name.empty(), "an actuator has no name");
      demand(names.insert(actuator.name).second,
             fmt::format("two actuators are called '{}'", actuator.name));
      demand(
          std::isfinite(actuator.min) && std::isfinite(actuator.max) && actuator.min < actuator.max,
          fmt::format("actuator '{}' has min = {:g}, must be finite and < max = {:g}",
                      actuator.name, actuator.min, actuator.max));
    }
  }

  void check_kinds() {
    demand(vehicle_.wheeled || vehicle_.flies(),
           "none of wheeled, rotorcraft and fixed_wing is given");
    demand(!vehicle_.steered || vehicle_.wheeled, "steered is given without wheeled");
    demand(!vehicle_.ackermann || vehicle_.wheeled, "ackermann is given without wheeled");
    demand(!vehicle_.ackermann || !vehicle_.steered, "ackermann and steered are both given");
  }

  void check_wheeled(const WheeledVehicle& wheeled) {
    positive("wheeled.track_m", wheeled.track_m);
    positive("wheeled.wheel_base_m", wheeled.wheel_base_m);
    positive("wheeled.wheel_radius_m", wheeled.wheel_radius_m);
    positive("wheeled.wheel_speed_limit_radps", wheeled.wheel_speed_limit_radps);
    not_negative("wheeled.effective_track_m", wheeled.effective_track_m);
    for (const WheelPlace& wheel : wheeled.wheels) {
      const auto count = static_cast<int>(vehicle_.actuators.size());
      const bool exists = wheel.actuator >= 0 && wheel.actuator < count;
      demand(exists && vehicle_.actuators[wheel.actuator].unit == "rad/s",
             fmt::format("wheeled.wheels has a wheel of actuator {}, which is not a speed in rad/s",
                         wheel.actuator));
    }
    const std::vector<Eigen::Vector2d> outline_B = vehicle_.outline_B();
    Eigen::Vector2d min_corner = outline_B.front(), max_corner = outline_B.front();
    for (const Eigen::Vector2d& corner : outline_B) {
      min_corner = min_corner.cwiseMin(corner);
      max_corner = max_corner.cwiseMax(corner);
    }
    const Eigen::Vector2d size_m = max_corner - min_corner;
    demand(size_m.x() >= wheeled.wheel_base_m - kSame_m && size_m.y() >= wheeled.track_m - kSame_m,
           fmt::format("the outline of {:g} x {:g} m does not contain the wheels, {:g} m apart "
                       "along and {:g} m across",
                       size_m.x(), size_m.y(), wheeled.wheel_base_m, wheeled.track_m));
    const double clearance_m = vehicle_.height_above_ground_m + vehicle_.collision_centre_B.z() -
                               vehicle_.collision_half_extents_m.z();
    demand(clearance_m >= -kSame_m,
           fmt::format("the collision box reaches {:g} m into level ground", -clearance_m));
  }

  void check_steered(const SteeredVehicle& steered) {
    positive("steered.front_axle_m", steered.front_axle_m);
    positive("steered.rear_axle_m", steered.rear_axle_m);
    acute("steered.max_axle_steer_rad", steered.max_axle_steer_rad);
    positive("steered.steer_rate_radps", steered.steer_rate_radps);
    not_negative("steered.steer_lag_s", steered.steer_lag_s);
    if (vehicle_.wheeled) {
      const double base_m = steered.front_axle_m + steered.rear_axle_m;
      demand(std::abs(base_m - vehicle_.wheeled->wheel_base_m) <= kSame_m,
             fmt::format("steered's axles are {:g} m apart, wheeled.wheel_base_m = {:g}", base_m,
                         vehicle_.wheeled->wheel_base_m));
    }
    has_actuator("steered", "axle_front_steer_rad");
    has_actuator("steered", "axle_rear_steer_rad");
  }

  void check_ackermann(const AckermannVehicle& ackermann) {
    positive("ackermann.rear_axle_m", ackermann.rear_axle_m);
    acute("ackermann.max_axle_steer_rad", ackermann.max_axle_steer_rad);
    positive("ackermann.steer_rate_radps", ackermann.steer_rate_radps);
    not_negative("ackermann.steer_lag_s", ackermann.steer_lag_s);
    if (vehicle_.wheeled) {
      demand(ackermann.rear_axle_m < vehicle_.wheeled->wheel_base_m,
             fmt::format("ackermann.rear_axle_m = {:g} puts the front axle behind B's origin; "
                         "wheeled.wheel_base_m = {:g}",
                         ackermann.rear_axle_m, vehicle_.wheeled->wheel_base_m));
    }
    has_actuator("ackermann", "axle_front_steer_rad");
  }

  void check_rotorcraft(const Rotorcraft& craft) {
    demand(!craft.rotors.empty(), "rotorcraft.rotors is empty");
    for (const double inertia_kgm2 : craft.inertia_kgm2) {
      positive("an entry of rotorcraft.inertia_kgm2", inertia_kgm2);
    }
    positive("rotorcraft.thrust_coefficient_Ns2", craft.thrust_coefficient_Ns2);
    positive("rotorcraft.torque_coefficient_Nms2", craft.torque_coefficient_Nms2);
    not_negative("rotorcraft.min_rotor_radps", craft.min_rotor_radps);
    demand(std::isfinite(craft.max_rotor_radps) && craft.max_rotor_radps > craft.min_rotor_radps,
           fmt::format("rotorcraft.max_rotor_radps = {:g}, must be > min_rotor_radps = {:g}",
                       craft.max_rotor_radps, craft.min_rotor_radps));
    not_negative("rotorcraft.rotor_lag_s", craft.rotor_lag_s);
    not_negative("rotorcraft.rotor_inertia_kgm2", craft.rotor_inertia_kgm2);
    not_negative("rotorcraft.rotor_drag_Ns_per_m", craft.rotor_drag_Ns_per_m);
    positive("rotorcraft.rotor_radius_m", craft.rotor_radius_m);
    not_negative("rotorcraft.tip_radius_m", craft.tip_radius_m);
    acute("rotorcraft.max_tilt_rad", craft.max_tilt_rad);
    positive("rotorcraft.landing_speed_limit_mps", craft.landing_speed_limit_mps);
    for (std::size_t i = 0; i < craft.rotors.size(); ++i) check_rotor(craft, i);
  }

  void check_rotor(const Rotorcraft& craft, std::size_t i) {
    const RotorPlace& rotor = craft.rotors[i];
    const std::string name = fmt::format("rotorcraft.rotors[{}]", i);
    demand(rotor.p_B.allFinite(), name + ".p_B is not finite");
    demand(std::abs(rotor.torque_sign) == 1.0,
           fmt::format("{}.torque_sign = {:g}, must be 1 or -1", name, rotor.torque_sign));
    const double reach_m = rotor.p_B.norm() + craft.rotor_radius_m;
    demand(craft.tip_radius_m == 0.0 || reach_m <= craft.tip_radius_m + kSame_m,
           fmt::format("{} reaches {:g} m from B's z axis, rotorcraft.tip_radius_m = {:g}", name,
                       reach_m, craft.tip_radius_m));
    has_actuator("rotorcraft", fmt::format("rotor_{}_speed_radps", i + 1));
  }

  void check_fixed_wing(const FixedWingAircraft& aircraft) {
    demand(aircraft.flight_model != nullptr, "fixed_wing.flight_model is null");
    if (aircraft.flight_model) {
      const double model_kg = aircraft.flight_model->mass_kg();
      demand(model_kg == vehicle_.mass_kg,
             fmt::format("fixed_wing.flight_model weighs {:g} kg, mass_kg = {:g}", model_kg,
                         vehicle_.mass_kg));
    }
    positive("fixed_wing.span_m", aircraft.span_m);
    not_negative("fixed_wing.wing_area_m2", aircraft.wing_area_m2);
    positive("fixed_wing.air_density_kgm3", aircraft.air_density_kgm3);
    positive("fixed_wing.cruise_speed_mps", aircraft.cruise_speed_mps);
    positive("fixed_wing.stall_speed_mps", aircraft.stall_speed_mps);
    demand(aircraft.cruise_speed_mps > aircraft.stall_speed_mps,
           fmt::format("fixed_wing.cruise_speed_mps = {:g}, must be > stall_speed_mps = {:g}",
                       aircraft.cruise_speed_mps, aircraft.stall_speed_mps));
    acute("fixed_wing.max_bank_rad", aircraft.max_bank_rad);
    not_negative("fixed_wing.throttle_lag_s", aircraft.throttle_lag_s);
    not_negative("fixed_wing.elevon_lag_s", aircraft.elevon_lag_s);
    demand(aircraft.launch_throttle >= 0.0 && aircraft.launch_throttle < 1.0,
           fmt::format("fixed_wing.launch_throttle = {:g}, must be >= 0 and < 1",
                       aircraft.launch_throttle));
    positive("fixed_wing.landing_sink_limit_mps", aircraft.landing_sink_limit_mps);
    not_negative("fixed_wing.belly_height_m", aircraft.belly_height_m);
    if (aircraft.start_height_m) positive("fixed_wing.start_height_m", *aircraft.start_height_m);
    for (const char* name : {"throttle", "elevon_left_rad", "elevon_right_rad"}) {
      has_actuator("fixed_wing", name);
    }
  }

  const VehicleDescription& vehicle_;
  std::optional<std::string> fault_;
};

}  // namespace

std::optional<std::string> find_fault(const VehicleDescription& vehicle) {
  return Check(vehicle).run();
}

}  // namespace vinerow
