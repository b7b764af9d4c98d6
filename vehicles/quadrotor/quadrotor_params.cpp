#include "vehicles/quadrotor/quadrotor_params.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"
#include "vehicles/parts/moments_of_inertia.h"

namespace vinerow::vehicles {
namespace {

std::string find_fault_in_shape(const QuadrotorParams& p) {
  // Neighbouring hubs are arm * sqrt(2) apart.
  if (std::sqrt(2.0) * p.arm_m <= 2.0 * p.rotor_radius_m) {
    return fmt::format(
        "rotors of rotor_radius_m = {:.4g} would strike each other on arms of arm_m = {:.4g}",
        p.rotor_radius_m, p.arm_m);
  }
  if (p.gear_radius_m > p.arm_m) {
    return fmt::format("gear_radius_m = {:.4g} is longer than arm_m = {:.4g}", p.gear_radius_m,
                       p.arm_m);
  }
  if (p.stand_height_m < 0.08) {
    return fmt::format(
        "stand_height_m = {:.4g}, must be 0.08 or more to keep the body off the ground",
        p.stand_height_m);
  }
  return "";
}

std::string find_fault_in_inertia(const QuadrotorParams& p) {
  return find_fault_in_moments("inertia_kgm2", p.inertia_kgm2);
}

const ParameterTable<QuadrotorFault>& fault_table() {
  using F = QuadrotorFault;
  static const ParameterTable<F> table =
      ParameterTable<F>()
          .choice("kind", &F::kind,
                  {{"rotor_failure", F::Kind::kRotorFailure},
                   {"battery_empty", F::Kind::kBatteryEmpty}},
                  "what fails")
          .required()
          .number("at_s", "s", &F::at_s, between(0.0, 1e9), "time of the fault")
          .required()
          .integer(
              "rotor", &F::rotor, between(1, kRotors),
              "rotor that fails: 1 is the front (left) one, the others follow counter-clockwise",
              kCountedFromOne)
          .number("remaining", "", &F::remaining, between(0.0, 1.0),
                  "share of the rotor's thrust that is left; default: 0")
          .rule([](const F& fault) -> std::string {
            if (fault.kind != F::Kind::kRotorFailure) {
              return fault.rotor || fault.remaining
                         ? "'rotor' and 'remaining' are keys of a rotor_failure"
                         : "";
            }
            if (fault.rotor) return "";
            return fmt::format("a rotor_failure must name its 'rotor' (1 to {})", kRotors);
          });
  return table;
}

const ParameterTable<QuadrotorParams>& quadrotor_table() {
  using P = QuadrotorParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("layout", &P::layout,
                  {{"x", QuadrotorLayout::kX}, {"plus", QuadrotorLayout::kPlus}},
                  "two rotors ahead, or one")
          .number("mass_kg", "kg", &P::mass_kg, kPositive, "take-off mass")
          .numbers("inertia_kgm2", "kg m2", &P::inertia_kgm2, kPositive,
                   "moments about the body's axes")
          .number("arm_m", "m", &P::arm_m, kPositive, "distance from the centre to a rotor's hub")
          .number("rotor_radius_m", "m", &P::rotor_radius_m, kPositive, "length of a blade")
          .number("rotor_height_m", "m", &P::rotor_height_m, between(0.0, 1.0),
                  "rotors' plane above the centre of mass")
          .number("stand_height_m", "m", &P::stand_height_m, kPositive,
                  "centre of mass above level ground, standing")
          .number("gear_radius_m", "m", &P::gear_radius_m, kPositive,
                  "distance from the centre to a foot of the landing gear")
          .include(&P::foot, landing_foot_table())
          .include(&P::rotor, rotor_table())
          .number("rotor_drag_Ns_per_m", "N s/m", &P::rotor_drag_Ns_per_m, between(0.0, 1e3),
                  "force of all rotors at hover against motion across their axes")
          .number("inflow_drag_Ns_per_m", "N s/m", &P::inflow_drag_Ns_per_m, between(0.0, 1e3),
                  "thrust that all rotors lose at hover per speed of climb")
          .number("body_drag_area_m2", "m2", &P::body_drag_area_m2, between(0.0, 100.0),
                  "drag coefficient times area of the body")
          .choice("ground_effect", &P::ground_effect,
                  {{"none", GroundEffectModel::kNone},
                   {"single", GroundEffectModel::kSingle},
                   {"multirotor", GroundEffectModel::kMultirotor}},
                  "Cheeseman and Bennett per rotor, or Sanchez-Cuevas et al. for four")
          .number("ground_effect_body_lift", "", &P::ground_effect_body_lift, between(0.0, 10.0),
                  "K_b: lift of the wake that turns up below the body")
          .number("motor_efficiency", "", &P::motor_efficiency, between(0.01, 1.0),
                  "shaft over electric power of motors and speed controllers")
          .include(&P::battery, battery_table())
          .number("landing_speed_limit_mps", "m/s", &P::landing_speed_limit_mps, kPositive,
                  "touching the ground faster than this is a crash")
          .degrees("landing_tilt_limit_deg", &P::landing_tilt_limit_rad, between(1.0, 90.0),
                   "touching the ground tilted more than this is a crash")
          .degrees("max_tilt_deg", &P::max_tilt_rad, between(1.0, 80.0),
                   "tilt in flight, for controllers")
          .number("max_speed_mps", "m/s", &P::max_speed_mps, kPositive,
                  "maximum speed that controllers command")
          .number("min_turning_radius_m", "m", &P::min_turning_radius_m, between(0.0, 1e3),
                  "minimum turning radius that planners use")
          .groups("faults", &P::faults, fault_table(), "faults during the flight")
          .rule(find_fault_in_shape)
          .rule(find_fault_in_inertia);
  return table;
}

}  // namespace

void QuadrotorParams::validate(double gravity_mps2) const {
  quadrotor_table().validate(*this, name);
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
  PartSpec spec;
  spec.name = "quadrotor";
  spec.description =
      "Rotorcraft with four rotors (papers A and C): speed lag, thrust and drag torque of speed "
      "squared, rotor inertia, drag in the wind, ground effect; X or + layout";
  spec.writes = {"rotors", "battery", "vehicle_event"};
  quadrotor_table().add_to(spec);
  return spec;
}

QuadrotorParams read_quadrotor_params(const ParameterSet& parameters, const std::string& name,
                                      double gravity_mps2) {
  QuadrotorParams p = quadrotor_table().read(parameters, name);
  p.name = name;
  p.validate(gravity_mps2);
  return p;
}

}  // namespace vinerow::vehicles
