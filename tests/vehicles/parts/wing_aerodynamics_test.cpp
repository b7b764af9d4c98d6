/// Lift, drag and moments against closed forms, at all attitudes and at rest.

#include "vehicles/parts/wing_aerodynamics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::vehicles::wing_aerodynamics_test {
namespace {

using Eigen::Vector3d;

/// Air from `alpha` below the nose and `beta` to the right of it, in B.
AirPoint air_at(double V, double alpha_rad, double beta_rad = 0.0) {
  AirPoint air;
  air.v_air_B = V * Vector3d(std::cos(alpha_rad) * std::cos(beta_rad), -std::sin(beta_rad),
                             -std::sin(alpha_rad) * std::cos(beta_rad));
  return air;
}

TEST(WingAerodynamics, LiftIsAcrossAndDragAlongTheAir) {
  WingParams p;
  p.stall = false;
  const double alpha = 0.1, V = 14.0, Q = 0.5 * 1.225 * V * V * 0.27;
  const AirLoad load = calc_wing_load(p, air_at(V, alpha), {});
  const Vector3d along(std::cos(alpha), 0, -std::sin(alpha)),
      up(std::sin(alpha), 0, std::cos(alpha));
  const double CL = 0.05 + 3.5 * 0.1, CD = 0.025 + CL * CL / (kPi * 0.85 * 3.0);
  EXPECT_NEAR(load.force_B.dot(up), Q * CL, 1e-12);
  EXPECT_NEAR(load.force_B.dot(along), -Q * CD, 1e-12);
  EXPECT_EQ(load.force_B.y(), 0.0);
  EXPECT_NEAR(load.torque_B.y(), -Q * 0.311 * (0.035 - 0.0309), 1e-12);  // nose up is about -y
}

TEST(WingAerodynamics, ElevonsPitchRollAndDrag) {
  WingParams p;
  p.stall = false;
  const double Q = 0.5 * 1.225 * 144.0 * 0.27;
  const AirLoad clean = calc_wing_load(p, air_at(12.0, 0.0), {});
  const AirLoad down = calc_wing_load(p, air_at(12.0, 0.0), {0.1, 0.1});
  EXPECT_NEAR(down.torque_B.y() - clean.torque_B.y(), Q * 0.311 * 0.032, 1e-12);
  EXPECT_NEAR(down.force_B.z() - clean.force_B.z(), Q * 0.0806, 1e-12);
  const AirLoad roll = calc_wing_load(p, air_at(12.0, 0.0), {0.1, -0.1});
  EXPECT_NEAR(roll.torque_B.x(), Q * 0.9 * 0.0194, 1e-12);   // to the right
  EXPECT_NEAR(roll.torque_B.z(), Q * 0.9 * 0.00095, 1e-12);  // adverse: nose to the left
  EXPECT_NEAR(roll.force_B.x() - clean.force_B.x(), -Q * 0.15 * 0.01, 1e-12);
  EXPECT_NEAR(roll.torque_B.y(), clean.torque_B.y(), 1e-15);
}

TEST(WingAerodynamics, SlipRollsAwayAndTurnsIntoTheAir) {
  const WingParams p;
  const AirLoad load = calc_wing_load(p, air_at(12.0, 0.05, 0.1), {});  // air from the right
  EXPECT_LT(load.torque_B.x(), 0.0);                                    // left wing down
  EXPECT_LT(load.torque_B.z(), 0.0);                                    // nose to the right
  EXPECT_GT(load.force_B.y(), 0.0);                                     // pushed to the left
}

TEST(WingAerodynamics, MirroredAirGivesMirroredLoads) {
  const WingParams p;
  AirPoint air = air_at(12.0, 0.3, 0.2), mirrored = air_at(12.0, 0.3, -0.2);
  air.w_WB_B = {0.5, -0.4, 0.3};
  mirrored.w_WB_B = {-0.5, -0.4, -0.3};
  const AirLoad a = calc_wing_load(p, air, {0.1, -0.05}),
                b = calc_wing_load(p, mirrored, {-0.05, 0.1});
  EXPECT_LT((a.force_B - Vector3d(b.force_B.x(), -b.force_B.y(), b.force_B.z())).norm(), 1e-12);
  EXPECT_LT((a.torque_B - Vector3d(-b.torque_B.x(), b.torque_B.y(), -b.torque_B.z())).norm(),
            1e-12);
}

/// 1/4 rho V S c^2 C_mq and so on: linear in rate and airspeed.
TEST(WingAerodynamics, RatesAreDampedInProportionToTheAirspeed) {
  const WingParams p;
  for (const double V : {0.01, 1.0, 12.0}) {
    AirPoint still = air_at(V, 0.0), turning = still;
    turning.w_WB_B = {0.7, 0.5, -0.6};
    const Vector3d damping =
        calc_wing_load(p, turning, {}).torque_B - calc_wing_load(p, still, {}).torque_B;
    const double k = 0.25 * 1.225 * V * 0.27;
    EXPECT_NEAR(damping.y(), k * 0.311 * 0.311 * -1.145 * 0.5, 1e-12);
    // p = 0.7, r = +0.6 (nose right).
    EXPECT_NEAR(damping.x(), k * 0.81 * (-0.384 * 0.7 + 0.152 * 0.6), 1e-12);
    EXPECT_NEAR(damping.z(), -k * 0.81 * (-0.047 * 0.7 - 0.036 * 0.6), 1e-12);
  }
}

TEST(WingAerodynamics, IsNothingAtRestAndContinuousThere) {
  const WingParams p;
  AirPoint air;
  air.w_WB_B = {3.0, -2.0, 1.0};
  EXPECT_EQ(calc_wing_load(p, air, {0.1, 0.2}).force_B.norm(), 0.0);
  for (int k = 0; k < 40; ++k) {
    air.v_air_B = 1e-6 * Vector3d(std::cos(k), std::sin(2.0 * k), std::sin(3.0 * k));
    const AirLoad load = calc_wing_load(p, air, {0.1, 0.2});
    EXPECT_LT(load.force_B.norm() + load.torque_B.norm(), 1e-5);
  }
}

TEST(WingAerodynamics, LiftHasAMaximumEitherSide) {
  const WingParams p;
  double best = 0.0, best_deg = 0.0, lowest = 0.0, lowest_deg = 0.0;
  for (double deg = -90.0; deg <= 90.0; deg += 0.1) {
    const double lift = calc_lift_drag(p, rad_from_deg(deg), {}).lift;
    if (std::abs(deg) > 35.0) continue;
    if (lift > best) best = lift, best_deg = deg;
    if (lift < lowest) lowest = lift, lowest_deg = deg;
  }
  EXPECT_NEAR(best, 1.17, 0.02);
  EXPECT_NEAR(best_deg, 19.5, 0.5);
  EXPECT_NEAR(lowest, -1.08, 0.02);
  EXPECT_NEAR(lowest_deg, -19.5, 0.5);
  // Beyond, less lift than straight before, and in the end a plate's.
  EXPECT_LT(calc_lift_drag(p, rad_from_deg(26.0), {}).lift, 0.5 * best);
  // With the elevons that hold it there it carries 1.0: stall at 8.4 m/s (reference, section 2).
  EXPECT_NEAR(calc_trimmed_lift_max(p, rad_from_deg(25.0)), 1.0, 0.01);
}

TEST(WingAerodynamics, DeepStallIsAFlatPlate) {
  const WingParams p;
  for (const double deg : {45.0, 60.0, 90.0, 135.0, -60.0, -120.0}) {
    const double a = rad_from_deg(deg), normal = 2.0 * std::sin(a) * std::abs(std::sin(a));
    const LiftDrag c = calc_lift_drag(p, a, {});
    EXPECT_NEAR(c.lift, normal * std::cos(a), 1e-6) << deg;
    EXPECT_NEAR(c.drag, 0.025 + normal * std::sin(a), 1e-6) << deg;
    EXPECT_NEAR(c.pitch, -0.25 * normal, 1e-6) << deg;  // the nose goes to where it falls
  }
}

TEST(WingAerodynamics, ElevonsAreWeakerBeyondStall) {
  const WingParams p;
  const auto power = [&](double deg) {
    return calc_lift_drag(p, rad_from_deg(deg), {0.1, 0.1}).pitch -
           calc_lift_drag(p, rad_from_deg(deg), {}).pitch;
  };
  EXPECT_NEAR(power(5.0), -0.032, 1e-5);
  EXPECT_NEAR(power(45.0), 0.3 * -0.032, 1e-5);
}

TEST(WingAerodynamics, StaysLinearWithoutStall) {
  WingParams p;
  p.stall = false;
  EXPECT_NEAR(calc_lift_drag(p, 1.0, {}).lift, 3.55, 1e-12);
  EXPECT_EQ(stalled_share(p, 1.5), 0.0);
}

/// Eq. 4.10 as printed, where it does not overflow.
TEST(WingAerodynamics, BlendsAsPrinted) {
  const WingParams p;
  const double M = 50.0, a0 = rad_from_deg(22.5);
  for (double a = -1.5; a < 1.6; a += 0.05) {
    const double e1 = std::exp(-M * (a - a0)), e2 = std::exp(M * (a + a0));
    EXPECT_NEAR(stalled_share(p, a), (1 + e1 + e2) / ((1 + e1) * (1 + e2)), 1e-12) << a;
  }
  WingParams sharp;
  sharp.stall_blend = 1000.0;
  EXPECT_EQ(stalled_share(sharp, -3.1), 1.0);
  EXPECT_EQ(stalled_share(sharp, 0.0), 0.0);
}

TEST(WingAerodynamics, RefusesBadNumbers) {
  const auto message = [](const auto& spoil) {
    WingParams p;
    spoil(p);
    try {
      p.validate("plane");
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message([](WingParams& p) { p.area_m2 = 0.0; }),
            "plane: wing_area_m2 = 0 m2, must be > 0 m2");
  EXPECT_EQ(message([](WingParams& p) { p.roll_p = 0.5; }),
            "plane: roll_p = 0.5 1/rad, must be >= -100 1/rad and <= 0 1/rad");
  EXPECT_EQ(message([](WingParams& p) { p.lift_alpha = NAN; }),
            "plane: lift_alpha = nan, must be a finite number");
}

}  // namespace
}  // namespace vinerow::vehicles::wing_aerodynamics_test
