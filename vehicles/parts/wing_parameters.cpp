/// Checks and scenario parameters of parts/wing_aerodynamics.h, from one table.

#include "engine/math/angles.h"
#include "vehicles/parts/validation.h"
#include "vehicles/parts/wing_aerodynamics.h"

namespace vinerow::vehicles {
namespace {

/// A coefficient: key in files, place in the struct, unit, range, one sentence.
struct Coefficient {
  const char* key;
  double WingParams::*value;
  const char* unit;
  double min, max;
  const char* description;
};

using W = WingParams;

constexpr Coefficient kCoefficients[] = {
    {"lift_0", &W::lift_0, "", -2, 2, "C_L0"},
    {"lift_alpha", &W::lift_alpha, "1/rad", 0, 10, "C_La, lift of the angle of attack"},
    {"lift_rate", &W::lift_rate, "1/rad", -50, 50, "C_Lq, lift of c q / 2V"},
    {"lift_elevator", &W::lift_elevator, "1/rad", -5, 5, "C_Lde, lift of both elevons"},
    {"drag_0", &W::drag_0, "", 0, 5, "C_D0, drag without lift"},
    {"oswald_efficiency", &W::oswald_efficiency, "", 0.05, 10, "e of the induced drag"},
    {"drag_deflection", &W::drag_deflection, "1/rad2", 0, 10,
     "C_Dd2, drag of the elevons' deflections squared"},
    {"pitch_0", &W::pitch_0, "", -2, 2, "C_m0, nose up > 0"},
    {"pitch_alpha", &W::pitch_alpha, "1/rad", -10, 10, "C_ma, < 0: stable"},
    {"pitch_rate", &W::pitch_rate, "1/rad", -100, 0, "C_mq, damping of c q / 2V"},
    {"pitch_elevator", &W::pitch_elevator, "1/rad", -10, 10, "C_mde, of both elevons down"},
    {"side_beta", &W::side_beta, "1/rad", -10, 10, "C_Yb, side force of the side slip's sine"},
    {"side_p", &W::side_p, "1/rad", -10, 10, "C_Yp, side force of p b / 2V"},
    {"side_r", &W::side_r, "1/rad", -10, 10, "C_Yr, side force of r b / 2V"},
    {"roll_beta", &W::roll_beta, "1/rad", -10, 10, "C_lb, < 0: stable"},
    {"roll_p", &W::roll_p, "1/rad", -100, 0, "C_lp, roll damping"},
    {"roll_r", &W::roll_r, "1/rad", -10, 10, "C_lr, roll of a yaw rate"},
    {"roll_aileron", &W::roll_aileron, "1/rad", -10, 10, "C_lda, left elevon down, right up"},
    {"yaw_beta", &W::yaw_beta, "1/rad", -10, 10, "C_nb, > 0: stable"},
    {"yaw_p", &W::yaw_p, "1/rad", -10, 10, "C_np, yaw of a roll rate"},
    {"yaw_r", &W::yaw_r, "1/rad", -100, 0, "C_nr, yaw damping"},
    {"yaw_aileron", &W::yaw_aileron, "1/rad", -10, 10, "C_nda, adverse yaw < 0"},
    {"stall_blend", &W::stall_blend, "1/rad", 1, 1000, "sharpness of the stall"},
    {"plate_arm", &W::plate_arm, "", -1, 1,
     "mean chords from the centre of mass back to a stalled wing's centre of pressure"},
    {"stalled_control", &W::stalled_control, "", 0, 1,
     "share of the elevons' effect that is left beyond stall"},
};

}  // namespace

void WingParams::validate(const std::string& who) const {
  demand_positive(who, "wing_area_m2", area_m2);
  demand_positive(who, "wing_span_m", span_m);
  demand_positive(who, "wing_chord_m", chord_m);
  for (const Coefficient& c : kCoefficients) demand_range(who, c.key, this->*c.value, c.min, c.max);
  demand_range(who, "stall_angle_deg", deg_from_rad(stall_angle_rad), 1.0, 80.0);
}

std::vector<ParameterSpec> wing_parameter_specs() {
  const WingParams d;
  std::vector<ParameterSpec> specs = {
      positive_parameter("wing_area_m2", "m2", d.area_m2, "reference area"),
      positive_parameter("wing_span_m", "m", d.span_m,
                         "from tip to tip, reference of roll and yaw"),
      positive_parameter("wing_chord_m", "m", d.chord_m,
                         "mean aerodynamic chord, reference of pitch"),
      boolean_parameter("stall", d.stall, "whether lift breaks down beyond stall_angle_deg"),
      number_parameter("stall_angle_deg", "deg", deg_from_rad(d.stall_angle_rad), 1, 80,
                       "angle of attack at which half of the flow has separated, either side")};
  for (const Coefficient& c : kCoefficients) {
    specs.push_back(number_parameter(c.key, c.unit, d.*c.value, c.min, c.max, c.description));
  }
  return specs;
}

WingParams read_wing_params(const ParameterSet& parameters) {
  WingParams p;
  p.area_m2 = parameters.number("wing_area_m2");
  p.span_m = parameters.number("wing_span_m");
  p.chord_m = parameters.number("wing_chord_m");
  p.stall = parameters.boolean("stall");
  p.stall_angle_rad = rad_from_deg(parameters.number("stall_angle_deg"));
  for (const Coefficient& c : kCoefficients) p.*c.value = parameters.number(c.key);
  return p;
}

}  // namespace vinerow::vehicles
