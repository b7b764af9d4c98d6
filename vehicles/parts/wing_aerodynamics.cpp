#include "vehicles/parts/wing_aerodynamics.h"

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::vehicles {
namespace {

/// Below this airspeed the lift of a pitch rate makes no more induced drag: C_L would be without
/// bounds.
constexpr double kSlow_mps = 1.0;

/// What depends on the angle of attack and the elevons alone.
struct StaticCoefficients {
  double lift, pitch, drag;  // drag without the induced one
  double attached, control;  // share of the flow, of the elevons' effect
};

StaticCoefficients calc_static(const WingParams& p, double alpha_rad, const Elevons& elevons) {
  const double stalled = stalled_share(p, alpha_rad);
  StaticCoefficients c;
  c.attached = 1.0 - stalled;
  c.control = 1.0 - stalled * (1.0 - p.stalled_control);
  const double elevator = c.control * elevons.elevator_rad();
  c.lift = c.attached * (p.lift_0 + p.lift_alpha * alpha_rad) + p.lift_elevator * elevator;
  c.pitch = c.attached * (p.pitch_0 + p.pitch_alpha * alpha_rad) + p.pitch_elevator * elevator;
  c.drag =
      p.drag_0 + 0.5 * p.drag_deflection *
                     (elevons.left_rad * elevons.left_rad + elevons.right_rad * elevons.right_rad);
  if (stalled == 0.0) return c;
  const double sine = std::sin(alpha_rad);
  const double plate = 2.0 * stalled * sine * std::abs(sine);  // normal force
  c.lift += plate * std::cos(alpha_rad);
  c.drag += plate * sine;
  c.pitch -= p.plate_arm * plate;
  return c;
}

double induced_drag(const WingParams& p, double lift) {
  return lift * lift / (kPi * p.oswald_efficiency * p.aspect_ratio());
}

}  // namespace

WingParams::WingParams() : stall_angle_rad(rad_from_deg(22.5)) {}

double stalled_share(const WingParams& p, double alpha_rad) {
  if (!p.stall) return 0.0;
  // Eq. 4.10 with both exponentials divided out, so that none overflows.
  const double above = 1.0 / (1.0 + std::exp(p.stall_blend * (alpha_rad - p.stall_angle_rad)));
  const double below = 1.0 / (1.0 + std::exp(-p.stall_blend * (alpha_rad + p.stall_angle_rad)));
  return 1.0 - above * below;
}

LiftDrag calc_lift_drag(const WingParams& p, double alpha_rad, const Elevons& elevons) {
  const StaticCoefficients c = calc_static(p, alpha_rad, elevons);
  return {c.lift, c.drag + c.attached * induced_drag(p, c.lift), c.pitch};
}

AirLoad calc_wing_load(const WingParams& p, const AirPoint& air, const Elevons& elevons) {
  AirLoad load;
  const double u = air.v_air_B.x(), v = -air.v_air_B.y(), w = -air.v_air_B.z();
  const double roll = air.w_WB_B.x(), pitch = -air.w_WB_B.y(), yaw = -air.w_WB_B.z();
  const double V = air.v_air_B.norm();
  if (V == 0.0) return load;
  const double plane_mps = std::hypot(u, w);
  const StaticCoefficients c = calc_static(p, std::atan2(w, u), elevons);

  // Pressure times area over V: 1/2 rho V S. Rates enter as speeds, c q / 2 and b p / 2.
  const double qs = 0.5 * air.air_density_kgm3 * V * p.area_m2;
  const double q_mps = 0.5 * p.chord_m * pitch;
  const double p_mps = 0.5 * p.span_m * roll, r_mps = 0.5 * p.span_m * yaw;

  const double lift = c.lift + p.lift_rate * q_mps / std::max(V, kSlow_mps);
  const double drag = c.drag + c.attached * induced_drag(p, lift);
  const double X = qs * (-drag * u + lift * w), Z = qs * (-drag * w - lift * u);
  const double Y = qs * (p.side_beta * v + p.side_p * p_mps + p.side_r * r_mps);

  const double aileron_mps = c.control * elevons.aileron_rad() * V;
  const double l =
      qs * p.span_m *
      (p.roll_beta * v + p.roll_p * p_mps + p.roll_r * r_mps + p.roll_aileron * aileron_mps);
  const double m = qs * p.chord_m * (c.pitch * plane_mps + p.pitch_rate * q_mps);
  const double n =
      qs * p.span_m *
      (p.yaw_beta * v + p.yaw_p * p_mps + p.yaw_r * r_mps + p.yaw_aileron * aileron_mps);
  load.force_B = {X, -Y, -Z};
  load.torque_B = {l, -m, -n};
  return load;
}

double calc_trimmed_lift_max(const WingParams& p, double elevon_max_rad) {
  double best = 0.0;
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    const double alpha_rad = 0.5 * kPi * i / kSteps;
    const StaticCoefficients clean = calc_static(p, alpha_rad, {});
    const double power = clean.control * p.pitch_elevator;
    if (power == 0.0) {
      best = std::max(best, clean.lift);
      continue;
    }
    const double elevator_rad = -clean.pitch / power;
    if (std::abs(elevator_rad) > elevon_max_rad) continue;
    best = std::max(best, clean.lift + clean.control * p.lift_elevator * elevator_rad);
  }
  return best;
}

}  // namespace vinerow::vehicles
