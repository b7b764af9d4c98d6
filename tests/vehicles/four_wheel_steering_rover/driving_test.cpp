/// Driven under physics on level ground: turns, crab, slip, energy.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/vehicles/four_wheel_steering_rover/rig.h"

namespace vinerow::vehicles::driving_test {
namespace {

using namespace test;

/// Speeds at which all wheels roll about the centre of a double Ackermann turn of radius R at B.
std::array<double, 4> rolling_speeds(double v_mps, double radius_m) {
  std::array<double, 4> speeds{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double lever =
        std::hypot(0.75, radius_m - 0.425 * kCorners[i].across);  // hub to the centre of rotation
    speeds[i] = v_mps * lever / radius_m / 0.2;
  }
  return speeds;
}

struct Turn {
  double radius_m;  ///< from the circle B draws
  double slip_rms;  ///< longitudinal, over wheels and time
  double slip_max;
};

/// Two thirds of a circle, after a run-in.
Turn drive_turn(const FourWheelSteeringRoverParams& params, double v_mps,
                const std::array<double, 4>& speeds_radps) {
  FourWheelRig rig(make_flat_world(), 0.0, params);
  const double axle_deg = deg_from_rad(params.max_axle_steer_rad());
  rig.actuate(axle_deg, -axle_deg, {});
  rig.run(1.0);
  rig.actuate(axle_deg, -axle_deg, speeds_radps);
  rig.run(3.0);
  // Circle through three points of the way.
  const double part_s = 1.3 * params.min_turning_radius_m() / v_mps;
  std::array<Eigen::Vector2d, 3> p;
  double squares = 0.0, largest = 0.0;
  int count = 0;
  for (Eigen::Vector2d& point : p) {
    point = rig.body().X_WB.p.head<2>();
    for (auto i = std::llround(part_s / 0.001); i > 0; --i) {
      rig.step();
      for (const WheelOutput& out : rig.vehicle.platform().outputs()) {
        squares += out.slip() * out.slip();
        largest = std::max(largest, std::abs(out.slip()));
        ++count;
      }
    }
  }
  const Eigen::Vector2d a = p[1] - p[0], b = p[2] - p[1], c = p[0] - p[2];
  const double area2 = std::abs(a.x() * b.y() - a.y() * b.x());
  return {a.norm() * b.norm() * c.norm() / (2.0 * area2), std::sqrt(squares / count), largest};
}

TEST(FourWheelSteeringRover, TightestTurnsHaveTheRadiusOfTheGeometry) {
  for (const bool limits_wheels : {false, true}) {
    FourWheelSteeringRoverParams params;
    params.limits_wheels = limits_wheels;
    const double expected = limits_wheels ? 2.192 : 1.767, v = 0.3;
    const Turn turn = drive_turn(params, v, rolling_speeds(v, expected));
    RecordProperty(limits_wheels ? "radius_wheel_limit_mm" : "radius_axle_limit_mm",
                   static_cast<int>(std::lround(1000.0 * turn.radius_m)));
    // The tyres need slip angles for the centripetal force m v^2 / R, but front and rear alike: the
    // circle shifts and keeps its radius. 0.3 % is left for round-off of the figures above and for
    // wheels that lean with the body.
    EXPECT_NEAR(turn.radius_m, expected, 0.003 * expected) << limits_wheels;
  }
}

TEST(FourWheelSteeringRover, SpeedsThatFitTheTurnHardlySlip) {
  const FourWheelSteeringRoverParams params;
  const double radius = params.min_turning_radius_m(), v = 0.8;
  const Turn fitting = drive_turn(params, v, rolling_speeds(v, radius));
  const Turn equal = drive_turn(params, v, {v / 0.2, v / 0.2, v / 0.2, v / 0.2});
  RecordProperty("fitting_slip_rms_ppm", static_cast<int>(std::lround(1e6 * fitting.slip_rms)));
  RecordProperty("equal_slip_rms_ppm", static_cast<int>(std::lround(1e6 * equal.slip_rms)));
  EXPECT_LT(fitting.slip_rms, equal.slip_rms / 3.0);
  EXPECT_LT(fitting.slip_max, 0.01);
  // Equal speeds: the wheels' ways are 0.87 and 1.31 of B's, so with the same rim speed in the
  // middle of them the inner ones drive at 20 % and the outer ones brake at 17 %.
  EXPECT_NEAR(equal.slip_rms, std::sqrt(0.5 * (0.202 * 0.202 + 0.168 * 0.168)), 0.02);
}

TEST(FourWheelSteeringRover, CrabGoesAlongItsAngleWithoutYaw) {
  FourWheelRig rig(make_flat_world());
  rig.actuate(10.0, 10.0, {});
  rig.run(1.0);
  const Eigen::Vector3d start = rig.body().X_WB.p;
  rig.actuate(10.0, 10.0, {4, 4, 4, 4});
  rig.run(10.0);
  const Eigen::Vector3d displacement = rig.body().X_WB.p - start;
  EXPECT_GT(displacement.norm(), 7.5);
  EXPECT_NEAR(deg_from_rad(std::atan2(displacement.y(), displacement.x())), 10.0, 0.05);
  EXPECT_NEAR(deg_from_rad(rig.yaw_rad()), 0.0, 0.01);
}

TEST(FourWheelSteeringRover, TwoWheelSteeringTurnsAboutTheRearAxle) {
  FourWheelRig rig(make_flat_world());
  rig.actuate(15.0, 0.0, {});
  rig.run(1.0);
  // The oracle's speeds for 15/0 deg at 1 m/s, here at 0.5 m/s.
  rig.actuate(15.0, 0.0, {0.5 * 4.7681, 0.5 * 5.4948, 0.5 * 4.5795, 0.5 * 5.3320});
  rig.run(6.0);
  EXPECT_NEAR(rig.body().w_WB_W.z(), 0.5 * 0.1771, 0.5 * 0.1771 * 0.01);
  // No side speed at the rear axle: v_y = w b at B.
  const Eigen::Vector3d v_B = rig.body().X_WB.q.conjugate() * rig.body().v_WB_W;
  EXPECT_NEAR(v_B.y(), 0.75 * rig.body().w_WB_W.z(), 0.003);
}

TEST(FourWheelSteeringRover, EnergyIsRollingResistanceOverEfficiency) {
  FourWheelRig rig(make_flat_world());
  rig.actuate(0, 0, {5, 5, 5, 5});
  rig.run(5.0);
  const double energy0 = rig.energy_J(), x0 = rig.body().X_WB.p.x();
  rig.run(20.0);
  const double distance_m = rig.body().X_WB.p.x() - x0;
  EXPECT_NEAR(distance_m, 20.0, 0.02);
  // Dry grass 0.06, 240 kg: 141 N; efficiency 0.85. Beside it 60 W of electronics and the copper
  // loss of four motors, 0.02 W/Nm2 times the square of a quarter of the torque each.
  const double resistance_N = 0.06 * 240.0 * kGravity;
  const double copper_W = 4.0 * 0.02 * std::pow(0.25 * resistance_N * 0.2, 2);
  const double expected = resistance_N * distance_m / 0.85 + (60.0 + copper_W) * 20.0;
  EXPECT_NEAR(rig.energy_J() - energy0, expected, 0.002 * expected);
}

TEST(FourWheelSteeringRover, ReachesItsTopSpeedUphillAndNoMore) {
  FourWheelRig rig(make_slope_world(rad_from_deg(15.0)));
  rig.actuate(0, 0, {8, 8, 8, 8});
  rig.run(6.0);
  // 240 kg up 15 deg with 0.06 of rolling resistance: 190 N a wheel, 304 W at 1.6 m/s; driving slip
  // of about 2 % at this load, F / N = 0.27 of a stiffness of 15 per unit slip.
  EXPECT_NEAR(rig.body().v_WB_W.norm(), 1.6, 0.05);
  EXPECT_LE(rig.body().v_WB_W.norm(), 1.6);
}

}  // namespace
}  // namespace vinerow::vehicles::driving_test
