// Axle angles to wheel angles and speeds, against the twelve reference cases.

#include "controllers/four_wheel_steering/axle_geometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/random.h"
#include "tests/controllers/four_wheel_steering/oracle.h"

namespace vinerow::test::axle_geometry_test {
namespace {

TEST(AxleGeometry, GivesTheWheelAnglesOfEveryReferenceCase) {
  for (const OracleCase& row : kOracle) {
    const controllers::Rolling rolling = controllers::calc_rolling({}, row.axles());
    for (int i = 0; i < controllers::kWheels; ++i) {
      EXPECT_NEAR(deg_from_rad(rolling.wheel_rad[i]), row.wheel_deg[i], 0.01)
          << row.front_deg << "/" << row.rear_deg << " wheel " << i;
    }
  }
}

TEST(AxleGeometry, GivesTheWheelSpeedsOfEveryReferenceCase) {
  for (const OracleCase& row : kOracle) {
    if (row.saturated) continue;
    const Eigen::Vector4d rim = controllers::calc_rolling({}, row.axles()).rim_mps(row.speed_mps);
    for (int i = 0; i < controllers::kWheels; ++i) {
      EXPECT_NEAR(rim[i] / 0.2, row.wheel_radps[i], 1e-4) << row.front_deg << " wheel " << i;
    }
  }
}

TEST(AxleGeometry, GivesYawRateAndIcrOfEveryReferenceCase) {
  for (const OracleCase& row : kOracle) {
    const controllers::Rolling rolling = controllers::calc_rolling({}, row.axles());
    EXPECT_NEAR(rolling.yaw_rate_radps(row.speed_mps), row.yaw_rate_radps, 5.1e-5) << row.front_deg;
    for (int i = 0; i < 2; ++i) {
      if (std::isinf(row.icr_m[i])) {
        EXPECT_GT(std::abs(rolling.icr_B()[1]), 1e9);
      } else {
        EXPECT_NEAR(rolling.icr_B()[i], row.icr_m[i], 1e-3 + 6e-5 * std::abs(row.icr_m[i]));
      }
    }
  }
}

// The rolling motion as a rigid body: every wheel's centre moves where the wheel points, at its rim
// speed.
TEST(AxleGeometry, MovesEveryWheelWhereItPoints) {
  RandomStream random(1, "test", "axles");
  for (int n = 0; n < 1000; ++n) {
    const controllers::AxleGeometry geometry{random.uniform(0.3, 1.2), random.uniform(0.3, 1.2),
                                             random.uniform(0.4, 1.5), 0.2};
    const AxleAngles axles{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    const double speed = random.uniform(-2.0, 2.0);
    const controllers::Rolling rolling = controllers::calc_rolling(geometry, axles);
    const double w = rolling.yaw_rate_radps(speed);
    const Eigen::Vector2d v = speed * Eigen::Vector2d(std::cos(rolling.side_slip_rad()),
                                                      std::sin(rolling.side_slip_rad()));
    const auto velocity_at = [&](const Eigen::Vector2d& p) {
      return Eigen::Vector2d(v.x() - w * p.y(), v.y() + w * p.x());
    };
    for (int i = 0; i < controllers::kWheels; ++i) {
      const double angle = rolling.wheel_rad[i], rim = rolling.rim_mps(speed)[i];
      const Eigen::Vector2d rolls(rim * std::cos(angle), rim * std::sin(angle));
      EXPECT_NEAR((velocity_at(geometry.wheel_B(i)) - rolls).norm(), 0.0, 1e-12);
    }
    const Eigen::Vector2d front = velocity_at({geometry.front_m, 0.0});
    const Eigen::Vector2d rear = velocity_at({-geometry.rear_m, 0.0});
    EXPECT_NEAR(front.y() * std::cos(axles.front_rad), front.x() * std::sin(axles.front_rad),
                1e-12);
    EXPECT_NEAR(rear.y() * std::cos(axles.rear_rad), rear.x() * std::sin(axles.rear_rad), 1e-12);
  }
}

TEST(AxleGeometry, PassesFromTurningToParallelWithoutAStep) {
  const double crab = 0.2;
  const Eigen::Vector4d parallel = controllers::calc_rolling({}, {crab, crab}).rim_mps(1.0);
  EXPECT_NEAR((parallel - Eigen::Vector4d::Ones()).norm(), 0.0, 1e-15);
  for (const double skew : {1e-4, 1e-8, 1e-12, 1e-15, 1e-300}) {
    for (const double sign : {-1.0, 1.0}) {
      const controllers::Rolling rolling =
          controllers::calc_rolling({}, {crab, crab + sign * skew});
      EXPECT_TRUE(rolling.wheel_rad.allFinite());
      EXPECT_LT((rolling.rim_mps(1.0) - parallel).norm(), 2.0 * skew + 1e-15);
    }
  }
}

TEST(AxleGeometry, ScalesTheSpeedToTheFastestWheel) {
  const controllers::Rolling rolling =
      controllers::calc_rolling({}, {rad_from_deg(10), rad_from_deg(-10)});
  for (const double sign : {1.0, -1.0}) {
    const double speed = controllers::limit_speed(rolling, sign * 1.6, 1.6);
    EXPECT_NEAR(rolling.rim_mps(speed).cwiseAbs().maxCoeff(), 1.6, 1e-12);
    // Row 3 of the reference: the outer wheel does 5.5698 rad/s at 1 m/s.
    EXPECT_NEAR(speed, sign * 8.0 / 5.5698, 2e-5);
  }
  EXPECT_EQ(controllers::limit_speed(rolling, 0.5, 1.6), 0.5);
}

TEST(AxleGeometry, TurnsAWheelBackwardsThatTheIcrPasses) {
  // 60 deg on both axles of a narrow wheel base: the ICR lies inside the left wheels.
  const controllers::AxleGeometry geometry{0.3, 0.3, 1.0, 0.2};
  const controllers::Rolling rolling =
      controllers::calc_rolling(geometry, {rad_from_deg(60), rad_from_deg(-60)});
  EXPECT_LT(rolling.icr_B().y(), 0.5);
  const Eigen::Vector4d rim = rolling.rim_mps(1.0);
  EXPECT_LT(rim[0], 0.0);
  EXPECT_LT(rim[2], 0.0);
  EXPECT_GT(rim[1], 0.0);
}

}  // namespace
}  // namespace vinerow::test::axle_geometry_test
