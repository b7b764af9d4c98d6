#include "vehicles/quadrotor/quadrotor_params.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/constants.h"
#include "engine/core/error.h"
#include "vehicles/parts/validation.h"

namespace vinerow::vehicles {
namespace {

void validate_shape(const QuadrotorParams& p) {
  demand_positive(p.name, "arm_m", p.arm_m);
  demand_positive(p.name, "rotor_radius_m", p.rotor_radius_m);
  demand_range(p.name, "rotor_height_m", p.rotor_height_m, 0.0, 1.0);
  demand_positive(p.name, "stand_height_m", p.stand_height_m);
  demand_positive(p.name, "gear_radius_m", p.gear_radius_m);
  p.foot.validate(p.name);
  // Neighbouring hubs are arm * sqrt(2) apart.
  if (std::sqrt(2.0) * p.arm_m <= 2.0 * p.rotor_radius_m) {
    throw ConfigError(fmt::format(
        "{}: rotors of rotor_radius_m = {:.4g} would strike each other on arms of arm_m = {:.4g}",
        p.name, p.rotor_radius_m, p.arm_m));
  }
  if (p.gear_radius_m > p.arm_m) {
    throw ConfigError(fmt::format("{}: gear_radius_m = {:.4g} is longer than arm_m = {:.4g}",
                                  p.name, p.gear_radius_m, p.arm_m));
  }
  if (p.stand_height_m < 0.08) {
    throw ConfigError(
        fmt::format("{}: stand_height_m = {:.4g}, must be 0.08 or more to keep the "
                    "body off the ground",
                    p.name, p.stand_height_m));
  }
}

std::vector<ParameterSpec> fault_fields() {
  return {
      required(choice_parameter("kind", "rotor_failure", {"rotor_failure", "battery_empty"},
                                "what fails")),
      required(number_parameter("at_s", "s", 0.0, 0.0, 1e9, "when")),
      optional(integer_parameter("rotor", 1, 1, kRotors,
                                 "which rotor fails: 1 is the front (left) one, the others "
                                 "follow counter-clockwise")),
      number_parameter("remaining", "", 0.0, 0.0, 1.0, "share of the rotor's thrust that is left")};
}

std::vector<QuadrotorFault> read_faults(const ParameterSet& parameters, const std::string& name) {
  std::vector<QuadrotorFault> faults;
  for (const ParameterSet& group : parameters.groups("faults")) {
    QuadrotorFault fault;
    fault.at_s = group.number("at_s");
    fault.remaining = group.number("remaining");
    if (group.text("kind") == "battery_empty") {
      fault.kind = QuadrotorFault::Kind::kBatteryEmpty;
    } else if (!group.has("rotor")) {
      throw ConfigError(
          fmt::format("{}: faults[{}]: a rotor_failure must tell which 'rotor' (1 to {})", name,
                      faults.size(), kRotors));
    } else {
      fault.rotor = static_cast<std::size_t>(group.integer("rotor")) - 1;
    }
    faults.push_back(fault);
  }
  return faults;
}

GroundEffectModel ground_effect_model(const std::string& text) {
  if (text == "none") return GroundEffectModel::kNone;
  return text == "single" ? GroundEffectModel::kSingle : GroundEffectModel::kMultirotor;
}

}  // namespace

void QuadrotorParams::validate(double gravity_mps2) const {
  demand_positive(name, "mass_kg", mass_kg);
  validate_shape(*this);
  for (int k = 0; k < 3; ++k) demand_positive(name, "inertia_kgm2", inertia_kgm2[k]);
  if (2.0 * inertia_kgm2.maxCoeff() > inertia_kgm2.sum()) {
    throw ConfigError(fmt::format(
        "{}: inertia_kgm2 = [{:.4g}, {:.4g}, {:.4g}] is that of no body: one of them is larger "
        "than the other two together",
        name, inertia_kgm2.x(), inertia_kgm2.y(), inertia_kgm2.z()));
  }
  rotor.validate(name);
  demand_not_negative(name, "rotor_drag_Ns_per_m", rotor_drag_Ns_per_m);
  demand_not_negative(name, "inflow_drag_Ns_per_m", inflow_drag_Ns_per_m);
  demand_not_negative(name, "body_drag_area_m2", body_drag_area_m2);
  demand_range(name, "ground_effect_body_lift", ground_effect_body_lift, 0.0, 10.0);
  demand_range(name, "motor_efficiency", motor_efficiency, 0.01, 1.0);
  battery.validate(name);
  demand_positive(name, "landing_speed_limit_mps", landing_speed_limit_mps);
  demand_range(name, "landing_tilt_limit_deg", deg_from_rad(landing_tilt_limit_rad), 1.0, 90.0);
  demand_range(name, "max_tilt_deg", deg_from_rad(max_tilt_rad), 1.0, 80.0);
  demand_positive(name, "max_speed_mps", max_speed_mps);
  demand_not_negative(name, "min_turning_radius_m", min_turning_radius_m);
  const double weight_N = mass_kg * gravity_mps2;
  if (max_thrust_N() <= weight_N) {
    throw ConfigError(
        fmt::format("{}: makes {:.1f} N at most, but weighs {:.1f} N: it cannot hover", name,
                    max_thrust_N(), weight_N));
  }
}

Eigen::Vector3d QuadrotorParams::hub_B(std::size_t i) const {
  const double first_rad = layout == QuadrotorLayout::kX ? kPi / 4 : 0.0;
  const double angle_rad = first_rad + kPi / 2 * static_cast<double>(i);
  return {arm_m * std::cos(angle_rad), arm_m * std::sin(angle_rad), rotor_height_m};
}

Eigen::Vector3d QuadrotorParams::foot_B(std::size_t i) const {
  const Eigen::Vector2d along = hub_B(i).head<2>() / arm_m * gear_radius_m;
  return {along.x(), along.y(), -stand_height_m};
}

double QuadrotorParams::max_thrust_N() const {
  return kRotors * rotor.thrust_coefficient_Ns2 * rotor.max_radps * rotor.max_radps;
}

double QuadrotorParams::hover_radps() const {
  return std::sqrt(mass_kg * kStandardGravity_mps2 / (kRotors * rotor.thrust_coefficient_Ns2));
}

RotorAir QuadrotorParams::rotor_air() const {
  const double speeds_radps = kRotors * hover_radps();
  return {rotor_drag_Ns_per_m / speeds_radps, inflow_drag_Ns_per_m / speeds_radps};
}

PartSpec quadrotor_spec() {
  const QuadrotorParams d;
  PartSpec spec;
  spec.name = "quadrotor";
  spec.description =
      "Rotorcraft with four rotors (papers A and C): speed lag, thrust and drag torque of speed "
      "squared, rotor inertia, drag in the wind, ground effect; X or + layout";
  spec.writes = {"rotors", "battery", "vehicle_event"};
  spec.parameters = {
      choice_parameter("layout", "x", {"x", "plus"}, "two rotors ahead, or one"),
      positive_parameter("mass_kg", "kg", d.mass_kg, "everything that flies"),
      number_list_parameter("inertia_kgm2", "kg m2",
                            {d.inertia_kgm2.x(), d.inertia_kgm2.y(), d.inertia_kgm2.z()},
                            "moments about the body's axes", 3),
      positive_parameter("arm_m", "m", d.arm_m, "from the middle to a rotor's hub"),
      positive_parameter("rotor_radius_m", "m", d.rotor_radius_m, "length of a blade"),
      number_parameter("rotor_height_m", "m", d.rotor_height_m, 0.0, 1.0,
                       "rotors' plane above the centre of mass"),
      positive_parameter("stand_height_m", "m", d.stand_height_m,
                         "centre of mass above level ground, standing"),
      positive_parameter("gear_radius_m", "m", d.gear_radius_m,
                         "from the middle to a foot of the landing gear"),
      positive_parameter("gear_stiffness_N_per_m", "N/m", d.foot.stiffness_N_per_m,
                         "of a leg with its foot, along and across"),
      number_parameter("gear_damping_Ns_per_m", "N s/m", d.foot.damping_Ns_per_m, 0.0, 1e5,
                       "of a leg with its foot"),
      number_parameter("gear_friction", "", d.foot.friction, 0.0, 10.0,
                       "Coulomb coefficient of feet on ground"),
      positive_parameter("thrust_coefficient_Ns2", "N s2", d.rotor.thrust_coefficient_Ns2,
                         "thrust of a rotor over its speed squared, at 1.225 kg/m3"),
      number_parameter("torque_coefficient_Nms2", "N m s2", d.rotor.torque_coefficient_Nms2, 0.0,
                       1.0, "drag torque of a rotor over its speed squared, at 1.225 kg/m3"),
      positive_parameter("max_rotor_radps", "rad/s", d.rotor.max_radps, "largest rotor speed"),
      number_parameter("rotor_rise_lag_s", "s", d.rotor.rise_lag_s, 0.0, 10.0,
                       "time constant of a rotor that speeds up"),
      number_parameter("rotor_fall_lag_s", "s", d.rotor.fall_lag_s, 0.0, 10.0,
                       "time constant of a rotor that slows down"),
      number_parameter("rotor_inertia_kgm2", "kg m2", d.rotor.inertia_kgm2, 0.0, 1.0,
                       "of blades, hub and motor bell about the axis"),
      number_parameter("rotor_drag_Ns_per_m", "N s/m", d.rotor_drag_Ns_per_m, 0.0, 1e3,
                       "force of all rotors at hover against motion across their axes"),
      number_parameter("inflow_drag_Ns_per_m", "N s/m", d.inflow_drag_Ns_per_m, 0.0, 1e3,
                       "thrust that all rotors lose at hover per speed of climb"),
      number_parameter("body_drag_area_m2", "m2", d.body_drag_area_m2, 0.0, 100.0,
                       "drag coefficient times area of the body"),
      choice_parameter("ground_effect", "multirotor", {"none", "single", "multirotor"},
                       "Cheeseman and Bennett per rotor, or Sanchez-Cuevas et al. for four"),
      number_parameter("ground_effect_body_lift", "", d.ground_effect_body_lift, 0.0, 10.0,
                       "K_b: lift of the wake that turns up below the body"),
      number_parameter("motor_efficiency", "", d.motor_efficiency, 0.01, 1.0,
                       "shaft over electric power of motors and speed controllers"),
      positive_parameter("battery_capacity_Wh", "Wh", d.battery.capacity_Wh, "full charge"),
      number_parameter("electronics_W", "W", d.battery.electronics_W, 0.0, 1e5,
                       "power drawn by computers, sensors and radio"),
      number_parameter("initial_charge", "", d.battery.initial_charge, 0.0, 1.0,
                       "share of the capacity at the start"),
      positive_parameter("landing_speed_limit_mps", "m/s", d.landing_speed_limit_mps,
                         "touching the ground faster than this is a crash"),
      number_parameter("landing_tilt_limit_deg", "deg", deg_from_rad(d.landing_tilt_limit_rad), 1.0,
                       90.0, "touching the ground tilted more than this is a crash"),
      number_parameter("max_tilt_deg", "deg", deg_from_rad(d.max_tilt_rad), 1.0, 80.0,
                       "tilt in flight, told to controllers"),
      positive_parameter("max_speed_mps", "m/s", d.max_speed_mps, "told to controllers"),
      number_parameter("min_turning_radius_m", "m", d.min_turning_radius_m, 0.0, 1e3,
                       "told to planners"),
      group_list_parameter("faults", fault_fields(), "what goes wrong during the flight"),
  };
  return spec;
}

QuadrotorParams read_quadrotor_params(const ParameterSet& parameters, const std::string& name,
                                      double gravity_mps2) {
  QuadrotorParams p;
  p.name = name;
  p.layout = parameters.text("layout") == "plus" ? QuadrotorLayout::kPlus : QuadrotorLayout::kX;
  p.mass_kg = parameters.number("mass_kg");
  p.inertia_kgm2 = Eigen::Vector3d(parameters.numbers("inertia_kgm2").data());
  p.arm_m = parameters.number("arm_m");
  p.rotor_radius_m = parameters.number("rotor_radius_m");
  p.rotor_height_m = parameters.number("rotor_height_m");
  p.stand_height_m = parameters.number("stand_height_m");
  p.gear_radius_m = parameters.number("gear_radius_m");
  p.foot.stiffness_N_per_m = parameters.number("gear_stiffness_N_per_m");
  p.foot.damping_Ns_per_m = parameters.number("gear_damping_Ns_per_m");
  p.foot.friction = parameters.number("gear_friction");
  p.rotor.thrust_coefficient_Ns2 = parameters.number("thrust_coefficient_Ns2");
  p.rotor.torque_coefficient_Nms2 = parameters.number("torque_coefficient_Nms2");
  p.rotor.max_radps = parameters.number("max_rotor_radps");
  p.rotor.rise_lag_s = parameters.number("rotor_rise_lag_s");
  p.rotor.fall_lag_s = parameters.number("rotor_fall_lag_s");
  p.rotor.inertia_kgm2 = parameters.number("rotor_inertia_kgm2");
  p.rotor_drag_Ns_per_m = parameters.number("rotor_drag_Ns_per_m");
  p.inflow_drag_Ns_per_m = parameters.number("inflow_drag_Ns_per_m");
  p.body_drag_area_m2 = parameters.number("body_drag_area_m2");
  p.ground_effect = ground_effect_model(parameters.text("ground_effect"));
  p.ground_effect_body_lift = parameters.number("ground_effect_body_lift");
  p.motor_efficiency = parameters.number("motor_efficiency");
  p.battery = {parameters.number("battery_capacity_Wh"), parameters.number("electronics_W"),
               parameters.number("initial_charge")};
  p.landing_speed_limit_mps = parameters.number("landing_speed_limit_mps");
  p.landing_tilt_limit_rad = rad_from_deg(parameters.number("landing_tilt_limit_deg"));
  p.max_tilt_rad = rad_from_deg(parameters.number("max_tilt_deg"));
  p.max_speed_mps = parameters.number("max_speed_mps");
  p.min_turning_radius_m = parameters.number("min_turning_radius_m");
  p.faults = read_faults(parameters, name);
  p.validate(gravity_mps2);
  return p;
}

}  // namespace vinerow::vehicles
