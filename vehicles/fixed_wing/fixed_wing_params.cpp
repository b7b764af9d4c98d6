#include "vehicles/fixed_wing/fixed_wing_params.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "engine/core/error.h"
#include "vehicles/parts/validation.h"

namespace vinerow::vehicles {
namespace {

constexpr double kSeaLevelDensity_kgm3 = 1.225;

void validate_inertia(const FixedWingParams& p) {
  for (int k = 0; k < 3; ++k) demand_positive(p.name, "inertia_kgm2", p.inertia_kgm2[k]);
  if (2.0 * p.inertia_kgm2.maxCoeff() > p.inertia_kgm2.sum()) {
    throw ConfigError(fmt::format(
        "{}: inertia_kgm2 = [{:.4g}, {:.4g}, {:.4g}] is that of no body: one of them is larger "
        "than the other two together",
        p.name, p.inertia_kgm2.x(), p.inertia_kgm2.y(), p.inertia_kgm2.z()));
  }
  const double most = std::sqrt(p.inertia_kgm2.x() * p.inertia_kgm2.z());
  if (!(std::abs(p.inertia_xz_kgm2) < most)) {
    throw ConfigError(
        fmt::format("{}: inertia_xz_kgm2 = {:.4g}, must be less than sqrt(Jx Jz) = {:.4g} either "
                    "side",
                    p.name, p.inertia_xz_kgm2, most));
  }
}

void validate_launch(const std::string& who, const LaunchParams& l) {
  demand_positive(who, "launch_height_m", l.height_m);
  demand_range(who, "launch_elevation_deg", deg_from_rad(l.elevation_rad), -10.0, 80.0);
  demand_range(who, "launch_incidence_deg", deg_from_rad(l.incidence_rad), -20.0, 20.0);
  demand_positive(who, "launch_length_m", l.length_m);
  demand_positive(who, "launch_speed_mps", l.speed_mps);
  demand_range(who, "launch_throttle", l.throttle, 0.0, 0.99);
  demand_positive(who, "start_height_m", l.start_height_m);
  demand_positive(who, "start_speed_mps", l.start_speed_mps);
}

void validate_shape(const std::string& who, const AirframeShape& s) {
  demand_positive(who, "root_chord_m", s.root_chord_m);
  demand_positive(who, "tip_chord_m", s.tip_chord_m);
  demand_range(who, "sweep_deg", deg_from_rad(s.sweep_rad), -45.0, 70.0);
  demand_range(who, "dihedral_deg", deg_from_rad(s.dihedral_rad), -20.0, 20.0);
  demand_range(who, "fin_height_m", s.fin_height_m, 0.01, 10.0);
  demand_positive(who, "belly_height_m", s.belly_m);
}

std::vector<ParameterSpec> fault_fields() {
  return {
      required(choice_parameter("kind", "motor_failure",
                                {"motor_failure", "elevon_stuck", "battery_empty"}, "what fails")),
      required(number_parameter("at_s", "s", 0.0, 0.0, 1e9, "when")),
      choice_parameter("elevon", "left", {"left", "right"}, "which elevon stays where it stands")};
}

FixedWingFault::Kind fault_kind(const std::string& text) {
  if (text == "battery_empty") return FixedWingFault::Kind::kBatteryEmpty;
  return text == "elevon_stuck" ? FixedWingFault::Kind::kElevonStuck
                                : FixedWingFault::Kind::kMotorFailure;
}

LaunchMode launch_mode(const std::string& text) {
  if (text == "air") return LaunchMode::kAir;
  return text == "catapult" ? LaunchMode::kCatapult : LaunchMode::kHand;
}

std::vector<ParameterSpec> launch_parameter_specs() {
  const LaunchParams d;
  return {
      choice_parameter("launch", "hand", {"hand", "catapult", "air"},
                       "thrown, pushed along a rail, or flying from the start"),
      positive_parameter("launch_height_m", "m", d.height_m,
                         "centre of mass above the ground before the push"),
      number_parameter("launch_elevation_deg", "deg", deg_from_rad(d.elevation_rad), -10, 80,
                       "of the push"),
      number_parameter("launch_incidence_deg", "deg", deg_from_rad(d.incidence_rad), -20, 20,
                       "of the body above the push"),
      positive_parameter("launch_length_m", "m", d.length_m, "of the push, evenly accelerated"),
      positive_parameter("launch_speed_mps", "m/s", d.speed_mps,
                         "at the end of the push, over ground"),
      number_parameter("launch_throttle", "", d.throttle, 0, 0.99,
                       "the push begins when more throttle is commanded"),
      positive_parameter("start_height_m", "m", d.start_height_m,
                         "launch: air; above the ground below"),
      positive_parameter("start_speed_mps", "m/s", d.start_speed_mps,
                         "launch: air; through the air, level"),
      optional(number_parameter("start_pitch_deg", "deg", 0, -89, 89,
                                "launch: air; nose up > 0, default: that of level flight")),
  };
}

std::vector<ParameterSpec> shape_parameter_specs() {
  const AirframeShape d;
  return {
      positive_parameter("root_chord_m", "m", d.root_chord_m, "drawn, and what touches"),
      positive_parameter("tip_chord_m", "m", d.tip_chord_m, "drawn, and what touches"),
      number_parameter("sweep_deg", "deg", deg_from_rad(d.sweep_rad), -45, 70,
                       "of the leading edge"),
      number_parameter("dihedral_deg", "deg", deg_from_rad(d.dihedral_rad), -20, 20, "as drawn"),
      number_parameter("leading_edge_m", "m", d.leading_edge_m, -10, 10,
                       "root's leading edge ahead of the centre of mass"),
      number_parameter("fin_height_m", "m", d.fin_height_m, 0.01, 10, "of the fins at the tips"),
      positive_parameter("belly_height_m", "m", d.belly_m,
                         "centre of mass above the ground when it lies there"),
  };
}

void append(std::vector<ParameterSpec> more, std::vector<ParameterSpec>& specs) {
  specs.insert(specs.end(), std::make_move_iterator(more.begin()),
               std::make_move_iterator(more.end()));
}

LaunchParams read_launch(const ParameterSet& parameters) {
  LaunchParams l;
  l.mode = launch_mode(parameters.text("launch"));
  l.height_m = parameters.number("launch_height_m");
  l.elevation_rad = rad_from_deg(parameters.number("launch_elevation_deg"));
  l.incidence_rad = rad_from_deg(parameters.number("launch_incidence_deg"));
  l.length_m = parameters.number("launch_length_m");
  l.speed_mps = parameters.number("launch_speed_mps");
  l.throttle = parameters.number("launch_throttle");
  l.start_height_m = parameters.number("start_height_m");
  l.start_speed_mps = parameters.number("start_speed_mps");
  if (parameters.has("start_pitch_deg")) {
    l.start_pitch_rad = rad_from_deg(parameters.number("start_pitch_deg"));
  }
  return l;
}

AirframeShape read_shape(const ParameterSet& parameters) {
  AirframeShape s;
  s.root_chord_m = parameters.number("root_chord_m");
  s.tip_chord_m = parameters.number("tip_chord_m");
  s.sweep_rad = rad_from_deg(parameters.number("sweep_deg"));
  s.dihedral_rad = rad_from_deg(parameters.number("dihedral_deg"));
  s.leading_edge_m = parameters.number("leading_edge_m");
  s.fin_height_m = parameters.number("fin_height_m");
  s.belly_m = parameters.number("belly_height_m");
  return s;
}

}  // namespace

void FixedWingParams::validate() const {
  demand_positive(name, "mass_kg", mass_kg);
  validate_inertia(*this);
  wing.validate(name);
  propeller.validate(name);
  demand_range(name, "elevon_limit_deg", deg_from_rad(elevon_limit_rad), 1.0, 60.0);
  demand_range(name, "elevon_lag_s", elevon_lag_s, 0.0, 10.0);
  demand_not_negative(name, "elevon_rate_degps", elevon_rate_radps);
  battery.validate(name);
  demand_positive(name, "cruise_speed_mps", cruise_speed_mps);
  demand_positive(name, "max_speed_mps", max_speed_mps);
  demand_range(name, "max_bank_deg", deg_from_rad(max_bank_rad), 1.0, 80.0);
  validate_launch(name, launch);
  demand_positive(name, "landing_sink_limit_mps", landing_sink_limit_mps);
  demand_range(name, "landing_tilt_limit_deg", deg_from_rad(landing_tilt_limit_rad), 1.0, 90.0);
  demand_not_negative(name, "belly_friction", belly_friction);
  validate_shape(name, shape);
}

Eigen::Matrix3d FixedWingParams::inertia_B() const {
  Eigen::Matrix3d inertia = inertia_kgm2.asDiagonal();
  inertia(0, 2) = inertia(2, 0) = inertia_xz_kgm2;  // -integral of x z dm with z up
  return inertia;
}

double FixedWingParams::stall_speed_mps(double gravity_mps2) const {
  const double lift = calc_trimmed_lift_max(wing, elevon_limit_rad);
  if (lift <= 0.0) return std::numeric_limits<double>::infinity();
  return std::sqrt(2.0 * mass_kg * gravity_mps2 / (kSeaLevelDensity_kgm3 * wing.area_m2 * lift));
}

PartSpec fixed_wing_spec() {
  const FixedWingParams d;
  PartSpec spec;
  spec.name = "fixed_wing";
  spec.description =
      "Flying wing with elevons and a propeller (paper A, section 2): six degrees of freedom by "
      "coefficients with stall (Beard, McLain 2012), launched by hand or catapult, lands on its "
      "belly";
  spec.writes = {"air", "battery", "vehicle_event"};
  spec.parameters = {
      positive_parameter("mass_kg", "kg", d.mass_kg, "everything that flies"),
      number_list_parameter("inertia_kgm2", "kg m2",
                            {d.inertia_kgm2.x(), d.inertia_kgm2.y(), d.inertia_kgm2.z()},
                            "Jx, Jy, Jz about the body's axes", 3),
      number_parameter("inertia_xz_kgm2", "kg m2", d.inertia_xz_kgm2, -1e6, 1e6,
                       "Jxz, integral of x z dm with z down")};
  append(wing_parameter_specs(), spec.parameters);
  append(propeller_parameter_specs(), spec.parameters);
  append(
      {number_parameter("elevon_limit_deg", "deg", deg_from_rad(d.elevon_limit_rad), 1, 60,
                        "either side"),
       number_parameter("elevon_lag_s", "s", d.elevon_lag_s, 0, 10, "time constant of the servos"),
       number_parameter("elevon_rate_degps", "deg/s", deg_from_rad(d.elevon_rate_radps), 0, 1e5,
                        "largest rate of the servos; 0: no limit"),
       positive_parameter("battery_capacity_Wh", "Wh", d.battery.capacity_Wh, "full charge"),
       number_parameter("electronics_W", "W", d.battery.electronics_W, 0.0, 1e5,
                        "power drawn by autopilot, servos, camera and radio"),
       number_parameter("initial_charge", "", d.battery.initial_charge, 0.0, 1.0,
                        "share of the capacity at the start"),
       positive_parameter("cruise_speed_mps", "m/s", d.cruise_speed_mps,
                          "through the air, told to controllers"),
       positive_parameter("max_speed_mps", "m/s", d.max_speed_mps, "told to controllers"),
       number_parameter("max_bank_deg", "deg", deg_from_rad(d.max_bank_rad), 1, 80,
                        "told to controllers"),
       positive_parameter("landing_sink_limit_mps", "m/s", d.landing_sink_limit_mps,
                          "meeting the ground faster than this, along its normal, is a crash"),
       number_parameter("landing_tilt_limit_deg", "deg", deg_from_rad(d.landing_tilt_limit_rad), 1,
                        90, "touching the ground tilted more than this is a crash"),
       number_parameter("belly_friction", "", d.belly_friction, 0, 10, "Coulomb, on the ground"),
       group_list_parameter("faults", fault_fields(), "what goes wrong during the flight")},
      spec.parameters);
  append(launch_parameter_specs(), spec.parameters);
  append(shape_parameter_specs(), spec.parameters);
  return spec;
}

FixedWingParams read_fixed_wing_params(const ParameterSet& parameters, const std::string& name,
                                       double gravity_mps2) {
  FixedWingParams p;
  p.name = name;
  p.mass_kg = parameters.number("mass_kg");
  p.inertia_kgm2 = Eigen::Vector3d(parameters.numbers("inertia_kgm2").data());
  p.inertia_xz_kgm2 = parameters.number("inertia_xz_kgm2");
  p.wing = read_wing_params(parameters);
  p.propeller = read_propeller_params(parameters);
  p.elevon_limit_rad = rad_from_deg(parameters.number("elevon_limit_deg"));
  p.elevon_lag_s = parameters.number("elevon_lag_s");
  p.elevon_rate_radps = rad_from_deg(parameters.number("elevon_rate_degps"));
  p.battery = {parameters.number("battery_capacity_Wh"), parameters.number("electronics_W"),
               parameters.number("initial_charge")};
  p.cruise_speed_mps = parameters.number("cruise_speed_mps");
  p.max_speed_mps = parameters.number("max_speed_mps");
  p.max_bank_rad = rad_from_deg(parameters.number("max_bank_deg"));
  p.launch = read_launch(parameters);
  p.landing_sink_limit_mps = parameters.number("landing_sink_limit_mps");
  p.landing_tilt_limit_rad = rad_from_deg(parameters.number("landing_tilt_limit_deg"));
  p.belly_friction = parameters.number("belly_friction");
  p.shape = read_shape(parameters);
  for (const ParameterSet& group : parameters.groups("faults")) {
    p.faults.push_back(
        {fault_kind(group.text("kind")), group.number("at_s"), group.text("elevon") == "left"});
  }
  p.validate();
  const double stall_mps = p.stall_speed_mps(gravity_mps2);
  if (p.cruise_speed_mps <= stall_mps) {
    throw ConfigError(fmt::format("{}: cruise_speed_mps = {:.4g}, but it stalls below {:.1f} m/s",
                                  name, p.cruise_speed_mps, stall_mps));
  }
  return p;
}

}  // namespace vinerow::vehicles
