#include "vehicles/fixed_wing/fixed_wing_params.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/decomposition.h"
#include "vehicles/parts/moments_of_inertia.h"

namespace vinerow::vehicles {
namespace {

constexpr double kSeaLevelDensity_kgm3 = 1.225;

std::string find_fault_in_wing_inertia(const FixedWingParams& p) {
  const Eigen::Vector3d& inertia = p.inertia_kgm2;
  std::string fault = find_fault_in_moments("inertia_kgm2", inertia);
  if (!fault.empty()) return fault;
  const double limit = std::sqrt(inertia.x() * inertia.z());
  if (!(std::abs(p.inertia_xz_kgm2) < limit)) {
    return fmt::format(
        "inertia_xz_kgm2 = {:.4g}, must be less than sqrt(Jx Jz) = {:.4g} either side",
        p.inertia_xz_kgm2, limit);
  }
  return find_fault_in_moments(
      fmt::format("inertia_xz_kgm2 = {:.4g}: the principal inertia", p.inertia_xz_kgm2),
      decompose_symmetric<3>(p.inertia_B()).values);
}

const ParameterTable<FixedWingFault>& wing_fault_table() {
  using F = FixedWingFault;
  static const ParameterTable<F> table =
      ParameterTable<F>()
          .choice("kind", &F::kind,
                  {{"motor_failure", F::Kind::kMotorFailure},
                   {"elevon_stuck", F::Kind::kElevonStuck},
                   {"battery_empty", F::Kind::kBatteryEmpty}},
                  "what fails")
          .required()
          .number("at_s", "s", &F::at_s, between(0.0, 1e9), "time of the fault")
          .required()
          .choice("elevon", &F::left, {{"left", true}, {"right", false}},
                  "elevon that stays at its present deflection; default: left")
          .rule([](const F& fault) -> std::string {
            if (fault.kind == F::Kind::kElevonStuck || !fault.left) return "";
            return "'elevon' is a key of elevon_stuck";
          });
  return table;
}

const ParameterTable<LaunchParams>& launch_table() {
  using P = LaunchParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("launch", &P::mode,
                  {{"hand", LaunchMode::kHand},
                   {"catapult", LaunchMode::kCatapult},
                   {"air", LaunchMode::kAir}},
                  "thrown, pushed along a rail, or flying from the start")
          .number("launch_height_m", "m", &P::height_m, kPositive,
                  "centre of mass above the ground before the push")
          .degrees("launch_elevation_deg", &P::elevation_rad, between(-10.0, 80.0),
                   "elevation of the launch track")
          .degrees("launch_incidence_deg", &P::incidence_rad, between(-20.0, 20.0),
                   "pitch of the body relative to the launch track")
          .number("launch_length_m", "m", &P::length_m, kPositive,
                  "length of the launch track; the acceleration is constant")
          .number("launch_speed_mps", "m/s", &P::speed_mps, kPositive,
                  "ground speed at the end of the launch track")
          .number("launch_throttle", "", &P::throttle, between(0.0, 0.99),
                  "throttle command above which the push starts")
          .number("start_height_m", "m", &P::start_height_m, kPositive,
                  "launch: air; above the ground below")
          .number("start_speed_mps", "m/s", &P::start_speed_mps, kPositive,
                  "launch: air; through the air, level")
          .degrees("start_pitch_deg", &P::start_pitch_rad, between(-89.0, 89.0),
                   "launch: air; nose up > 0, default: that of level flight");
  return table;
}

const ParameterTable<AirframeShape>& airframe_table() {
  using P = AirframeShape;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("root_chord_m", "m", &P::root_chord_m, kPositive,
                  "chord at the root, of mesh and collision shape")
          .number("tip_chord_m", "m", &P::tip_chord_m, kPositive,
                  "chord at the tip, of mesh and collision shape")
          .degrees("sweep_deg", &P::sweep_rad, between(-45.0, 70.0), "sweep of the leading edge")
          .degrees("dihedral_deg", &P::dihedral_rad, between(-20.0, 20.0),
                   "dihedral angle in pictures")
          .number("leading_edge_m", "m", &P::leading_edge_m, between(-10.0, 10.0),
                  "root's leading edge ahead of the centre of mass")
          .number("fin_height_m", "m", &P::fin_height_m, between(0.01, 10.0),
                  "height of the fins at the wing tips")
          .number("belly_height_m", "m", &P::belly_m, kPositive,
                  "height of the centre of mass when it rests on the ground");
  return table;
}

const ParameterTable<FixedWingParams>& fixed_wing_table() {
  using P = FixedWingParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("mass_kg", "kg", &P::mass_kg, kPositive, "take-off mass")
          .numbers("inertia_kgm2", "kg m2", &P::inertia_kgm2, kPositive,
                   "Jx, Jy, Jz about the body's axes")
          .number("inertia_xz_kgm2", "kg m2", &P::inertia_xz_kgm2, between(-1e6, 1e6),
                  "Jxz, integral of x z dm with z down")
          .include(&P::wing, wing_table())
          .include(&P::propeller, propeller_table())
          .degrees("elevon_limit_deg", &P::elevon_limit_rad, between(1.0, 60.0),
                   "maximum deflection to either side")
          .number("elevon_lag_s", "s", &P::elevon_lag_s, between(0.0, 10.0),
                  "time constant of the servos")
          .number("elevon_rate_degps", "deg/s", &P::elevon_rate_radps, between(0.0, 1e5),
                  "largest rate of the servos; 0: no limit", kDegrees)
          .include(&P::battery, battery_table())
          .reword("electronics_W", "power drawn by autopilot, servos, camera and radio")
          .number("cruise_speed_mps", "m/s", &P::cruise_speed_mps, kPositive,
                  "airspeed, for controllers")
          .number("max_speed_mps", "m/s", &P::max_speed_mps, kPositive,
                  "maximum speed that controllers command")
          .degrees("max_bank_deg", &P::max_bank_rad, between(1.0, 80.0),
                   "maximum bank that controllers command")
          .number("landing_sink_limit_mps", "m/s", &P::landing_sink_limit_mps, kPositive,
                  "meeting the ground faster than this, along its normal, is a crash")
          .degrees("landing_tilt_limit_deg", &P::landing_tilt_limit_rad, between(1.0, 90.0),
                   "touching the ground tilted more than this is a crash")
          .number("belly_friction", "", &P::belly_friction, between(0.0, 10.0),
                  "Coulomb, on the ground")
          .groups("faults", &P::faults, wing_fault_table(), "faults during the flight")
          .include(&P::launch, launch_table())
          .include(&P::shape, airframe_table())
          .rule(find_fault_in_wing_inertia);
  return table;
}

}  // namespace

void FixedWingParams::validate() const {
  fixed_wing_table().validate(*this, name);
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
  PartSpec spec;
  spec.name = "fixed_wing";
  spec.description =
      "Flying wing with elevons and a propeller (paper A, section 2): six degrees of freedom by "
      "coefficients with stall (Beard, McLain 2012), launched by hand or catapult, lands on its "
      "belly";
  spec.writes = {"air", "battery", "vehicle_event"};
  fixed_wing_table().add_to(spec);
  return spec;
}

FixedWingParams read_fixed_wing_params(const ParameterSet& parameters, const std::string& name,
                                       double gravity_mps2) {
  FixedWingParams p = fixed_wing_table().read(parameters, name);
  p.name = name;
  const double stall_mps = p.stall_speed_mps(gravity_mps2);
  if (p.cruise_speed_mps <= stall_mps) {
    throw ConfigError(fmt::format("{}: cruise_speed_mps = {:.4g}, but it stalls below {:.1f} m/s",
                                  name, p.cruise_speed_mps, stall_mps));
  }
  return p;
}

}  // namespace vinerow::vehicles
