/// On hillsides: standing, drifting, working a day.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/vehicles/four_wheel_steering_rover/rig.h"

namespace vinerow::vehicles::slopes_test {
namespace {

using namespace test;

TEST(FourWheelSteeringRover, StandsOnTwentyDegreesForAMinuteInAnyHeading) {
  struct Stand {
    double yaw_deg, steer_deg;
  };
  for (const auto& [yaw_deg, steer_deg] :
       {Stand{0, 0}, Stand{35, 0}, Stand{35, 23}, Stand{90, 0}, Stand{90, 23}, Stand{160, 0}}) {
    FourWheelRig rig(make_slope_world(rad_from_deg(20.0)), rad_from_deg(yaw_deg));
    rig.actuate(steer_deg, -steer_deg, {});
    rig.run(3.0);  // to settle on its springs
    const Eigen::Vector3d start = rig.body().X_WB.p;
    rig.run(60.0);
    const double moved_m = (rig.body().X_WB.p - start).norm();
    RecordProperty(fmt::format("moved_nm_{}_{}", yaw_deg, steer_deg),
                   static_cast<int>(std::lround(1e9 * moved_m)));
    EXPECT_LT(moved_m, 1e-4) << "heading " << yaw_deg << " deg, steered " << steer_deg << " deg";
  }
}

/// Side speed at which the tyres of a wheel rolling at `rolling_mps` carry `ratio` = F_y / N
/// without drive: F_y / N = mu (1 - exp(-c sigma / mu)), sigma = v_s / V_r, mu falling with v_s by
/// the Stribeck law (vehicles/parts/README.md), by bisection.
double closed_form_side_speed(double ratio, double rolling_mps, const Soil& soil) {
  const auto carried = [&](double v_s) {
    const double mu =
        soil.sliding_friction + (soil.peak_friction - soil.sliding_friction) * std::exp(-v_s * v_s);
    return mu * (1.0 - std::exp(-soil.cornering_stiffness_per_rad * v_s / rolling_mps / mu));
  };
  double low = 0.0, high = rolling_mps;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (carried(middle) < ratio ? low : high) = middle;
  }
  return low;
}

TEST(FourWheelSteeringRover, DriftsAlongASideSlopeAsTheTyreModelSays) {
  const double slope_rad = rad_from_deg(15.0);
  for (const bool wet : {false, true}) {
    WorldModel model = make_slope_world(slope_rad);
    if (wet) model.soil = {"wet_soil", 0.50, 0.40, 9.0, 6.0, 0.11};
    const Soil soil = model.soil;
    // Heading along +y: the slope rises to the right (+x). A gentle start, so that it stays so.
    FourWheelRig rig(std::move(model), rad_from_deg(90.0));
    rig.run(1.0);
    for (int i = 1; i <= 50; ++i) {
      const double speed = 0.1 * i;
      rig.actuate(0, 0, {speed, speed, speed, speed});
      rig.run(0.1);
    }
    rig.run(3.0);
    const Eigen::Vector3d start = rig.body().X_WB.p;
    const double yaw0 = rig.yaw_rad();
    rig.run(10.0);
    const Eigen::Vector3d displacement = rig.body().X_WB.p - start;
    // Along the contour and down the fall line, measured in the slope's plane; the drift is the
    // angle from the heading. The heading itself swings downhill by 0.03 (dry) to 0.14 deg/s (wet):
    // the motors' torque against the rolling resistance loads the rear axle by 1.5 % more, and the
    // front one needs more slip for its share.
    const double along = displacement.y(), down = -displacement.x() / std::cos(slope_rad);
    const double heading = 0.5 * (yaw0 + rig.yaw_rad()) - rad_from_deg(90.0);
    // All wheels have the same slip and forces proportional to their loads, so the load transfer
    // to the lower wheels cancels: the sum is m g sin = m g cos * (F_y / N).
    const double v_s = closed_form_side_speed(std::tan(slope_rad), 1.0, soil);
    const double expected = std::atan(v_s / 1.0), drift = std::atan2(down, along) - heading;
    RecordProperty(wet ? "drift_wet_mdeg" : "drift_dry_mdeg",
                   static_cast<int>(std::lround(1000.0 * deg_from_rad(drift))));
    RecordProperty(wet ? "closed_form_wet_mdeg" : "closed_form_dry_mdeg",
                   static_cast<int>(std::lround(1000.0 * deg_from_rad(expected))));
    RecordProperty(wet ? "swing_wet_mdegps" : "swing_dry_mdegps",
                   static_cast<int>(std::lround(100.0 * deg_from_rad(rig.yaw_rad() - yaw0))));
    EXPECT_NEAR(along, 10.0, 0.05);
    EXPECT_NEAR(drift, expected, 0.02 * expected) << soil.name;
    EXPECT_LT(deg_from_rad(std::abs(rig.yaw_rad() - yaw0)), 1.5);
    // The linear law alone would be 20 % off: the test would see it.
    EXPECT_GT(expected, 1.2 * std::tan(slope_rad) / soil.cornering_stiffness_per_rad);
  }
}

TEST(FourWheelSteeringRover, ABatteryLastsEightHoursOfRowsOnFourteenDegrees) {
  // Parcel F rises 30 m over rows of 118 m and a width of 40 m, 12 deg off the rows: 13.6 deg.
  const double slope_rad = rad_from_deg(14.0);
  double energy_J = 0.0, distance_m = 0.0, time_s = 0.0;
  for (const double yaw_deg : {0.0, 180.0}) {
    FourWheelRig rig(make_slope_world(slope_rad), rad_from_deg(yaw_deg));
    rig.actuate(0, 0, {5, 5, 5, 5});
    rig.run(4.0);
    const double energy0 = rig.energy_J();
    const Eigen::Vector3d start = rig.body().X_WB.p;
    rig.run(20.0);
    energy_J += rig.energy_J() - energy0;
    distance_m += (rig.body().X_WB.p - start).norm();
    time_s += 20.0;
  }
  const double mean_W = energy_J / time_s;
  RecordProperty("mean_power_W", static_cast<int>(std::lround(mean_W)));
  EXPECT_NEAR(distance_m / time_s, 1.0, 0.03);
  // By hand, without slip: up the motors drive at their efficiency, down half of the braking power
  // comes back.
  const double mg = 240.0 * kGravity;
  const double up_N = mg * (std::sin(slope_rad) + 0.06 * std::cos(slope_rad));
  const double down_N = mg * (std::sin(slope_rad) - 0.06 * std::cos(slope_rad));
  const double copper_W =
      0.5 * 4.0 * 0.02 * (std::pow(0.05 * up_N, 2) + std::pow(0.05 * down_N, 2));
  const double by_hand_W = 0.5 * (up_N / 0.85 - 0.5 * down_N) + copper_W + 60.0;
  EXPECT_NEAR(mean_W, by_hand_W, 0.04 * by_hand_W);  // driving slip is up to 2 %
  const FourWheelSteeringRover rover{FourWheelSteeringRoverParams{}};
  const double capacity_J = rover.description().battery_capacity_J.value();
  EXPECT_GT(capacity_J / mean_W, 8.0 * 3600.0);
}

}  // namespace
}  // namespace vinerow::vehicles::slopes_test
