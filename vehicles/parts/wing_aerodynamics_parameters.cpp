/// Checks and scenario parameters of parts/wing_aerodynamics.h.

#include "engine/api/parameter_table.h"
#include "vehicles/parts/wing_aerodynamics.h"

namespace vinerow::vehicles {

void WingParams::validate(const std::string& who) const {
  wing_table().validate(*this, who);
}

const ParameterTable<WingParams>& wing_table() {
  using P = WingParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("wing_area_m2", "m2", &P::area_m2, kPositive, "reference area")
          .number("wing_span_m", "m", &P::span_m, kPositive,
                  "span from tip to tip; reference length of roll and yaw moments")
          .number("wing_chord_m", "m", &P::chord_m, kPositive,
                  "mean aerodynamic chord, reference of pitch")
          .boolean("stall", &P::stall, "true: lift collapses beyond stall_angle_deg")
          .degrees("stall_angle_deg", &P::stall_angle_rad, between(1.0, 80.0),
                   "angle of attack at which half of the flow has separated, either side")
          .number("lift_0", "", &P::lift_0, between(-2.0, 2.0),
                  "C_L0: lift coefficient at zero angle of attack")
          .number("lift_alpha", "1/rad", &P::lift_alpha, between(0.0, 10.0),
                  "C_La, lift of the angle of attack")
          .number("lift_rate", "1/rad", &P::lift_rate, between(-50.0, 50.0),
                  "C_Lq, lift of c q / 2V")
          .number("lift_elevator", "1/rad", &P::lift_elevator, between(-5.0, 5.0),
                  "C_Lde, lift of both elevons")
          .number("drag_0", "", &P::drag_0, between(0.0, 5.0), "C_D0, drag without lift")
          .number("oswald_efficiency", "", &P::oswald_efficiency, between(0.05, 10.0),
                  "e of the induced drag")
          .number("drag_deflection", "1/rad2", &P::drag_deflection, between(0.0, 10.0),
                  "C_Dd2, drag of the elevons' deflections squared")
          .number("pitch_0", "", &P::pitch_0, between(-2.0, 2.0), "C_m0, nose up > 0")
          .number("pitch_alpha", "1/rad", &P::pitch_alpha, between(-10.0, 10.0),
                  "C_ma, < 0: stable")
          .number("pitch_rate", "1/rad", &P::pitch_rate, between(-100.0, 0.0),
                  "C_mq, damping of c q / 2V")
          .number("pitch_elevator", "1/rad", &P::pitch_elevator, between(-10.0, 10.0),
                  "C_mde, of both elevons down")
          .number("side_beta", "1/rad", &P::side_beta, between(-10.0, 10.0),
                  "C_Yb, side force of the side slip's sine")
          .number("side_p", "1/rad", &P::side_p, between(-10.0, 10.0),
                  "C_Yp, side force of p b / 2V")
          .number("side_r", "1/rad", &P::side_r, between(-10.0, 10.0),
                  "C_Yr, side force of r b / 2V")
          .number("roll_beta", "1/rad", &P::roll_beta, between(-10.0, 10.0), "C_lb, < 0: stable")
          .number("roll_p", "1/rad", &P::roll_p, between(-100.0, 0.0), "C_lp, roll damping")
          .number("roll_r", "1/rad", &P::roll_r, between(-10.0, 10.0), "C_lr, roll of a yaw rate")
          .number("roll_aileron", "1/rad", &P::roll_aileron, between(-10.0, 10.0),
                  "C_lda, left elevon down, right up")
          .number("yaw_beta", "1/rad", &P::yaw_beta, between(-10.0, 10.0), "C_nb, > 0: stable")
          .number("yaw_p", "1/rad", &P::yaw_p, between(-10.0, 10.0), "C_np, yaw of a roll rate")
          .number("yaw_r", "1/rad", &P::yaw_r, between(-100.0, 0.0), "C_nr, yaw damping")
          .number("yaw_aileron", "1/rad", &P::yaw_aileron, between(-10.0, 10.0),
                  "C_nda, adverse yaw < 0")
          .number("stall_blend", "1/rad", &P::stall_blend, between(1.0, 1000.0),
                  "sharpness of the stall")
          .number("plate_arm", "", &P::plate_arm, between(-1.0, 1.0),
                  "mean chords from the centre of mass back to a stalled wing's centre of pressure")
          .number("stalled_control", "", &P::stalled_control, between(0.0, 1.0),
                  "share of the elevons' effect that is left beyond stall");
  return table;
}

}  // namespace vinerow::vehicles
