// The steering law alone: signs, limits, and the error dynamics on exact kinematics.

#include "controllers/four_wheel_steering/steering_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::test::steering_law_test {
namespace {

const controllers::AxleGeometry kGeometry;
const double kLimit_rad = rad_from_deg(23.0);

controllers::SteeringParams with_gains(double lateral, double heading) {
  controllers::SteeringParams params;
  params.lateral_gain_radpm = lateral;
  params.heading_gain_per_m = heading;
  params.max_axle_rad = kLimit_rad;
  return params;
}

TEST(SteeringLaw, TurnsBothAxlesTowardsThePathAndOppositeForCurvature) {
  const controllers::SteeringParams params = with_gains(0.6, 1.2);
  const AxleAngles left_of_path =
      controllers::steer(kGeometry, params, {.lateral_error_m = 0.1}).axles;
  EXPECT_NEAR(left_of_path.front_rad, -0.06, 1e-12);
  EXPECT_NEAR(left_of_path.rear_rad, -0.06, 1e-12);
  const AxleAngles turned_left =
      controllers::steer(kGeometry, params, {.heading_error_rad = 0.1}).axles;
  EXPECT_NEAR(turned_left.front_rad, -std::atan(0.75 * 0.12), 1e-12);
  EXPECT_NEAR(turned_left.rear_rad, std::atan(0.75 * 0.12), 1e-12);
}

// Eq. 26 backwards: the angles roll with the gamma and kappa asked for.
TEST(SteeringLaw, RollsAsAsked) {
  RandomStream random(1, "test", "law");
  for (int i = 0; i < 1000; ++i) {
    const controllers::AxleGeometry geometry{random.uniform(0.5, 1.0), random.uniform(0.5, 1.0),
                                             0.85, 0.2};
    const controllers::SteeringInput input{.lateral_error_m = random.uniform(-0.2, 0.2),
                                           .reference_per_m = random.uniform(-0.2, 0.2)};
    const controllers::SteeringCommand command =
        controllers::steer(geometry, with_gains(0.6, 1.2), input);
    const controllers::Rolling rolling = controllers::calc_rolling(geometry, command.axles);
    EXPECT_NEAR(rolling.side_slip_rad(), -0.6 * input.lateral_error_m, 1e-12);
    EXPECT_NEAR(rolling.track_curvature_per_m(), input.reference_per_m, 1e-12);
  }
}

TEST(SteeringLaw, KeepsTheCurvatureAtTheAxleLimit) {
  RandomStream random(2, "test", "law");
  int cut = 0, whole = 0;
  for (int i = 0; i < 5000; ++i) {
    const controllers::AxleGeometry geometry{random.uniform(0.5, 1.0), random.uniform(0.5, 1.0),
                                             0.85, 0.2};
    const double largest = controllers::calc_largest_curvature(geometry, kLimit_rad);
    const double kappa = random.uniform(-1.3 * largest, 1.3 * largest);
    const double gamma = random.uniform(-0.6, 0.6);
    const controllers::SteeringCommand command = controllers::steer(
        geometry, with_gains(1.0, 1.2), {.lateral_error_m = -gamma, .reference_per_m = kappa});
    EXPECT_LE(std::abs(command.axles.front_rad), kLimit_rad);
    EXPECT_LE(std::abs(command.axles.rear_rad), kLimit_rad);
    const controllers::Rolling rolling = controllers::calc_rolling(geometry, command.axles);
    EXPECT_NEAR(rolling.track_curvature_per_m(), std::clamp(kappa, -largest, largest), 1e-9);
    // Gamma is given up only where an axle is at its limit, and never overshoots.
    const bool at_limit = std::abs(command.axles.front_rad) > kLimit_rad - 1e-9 ||
                          std::abs(command.axles.rear_rad) > kLimit_rad - 1e-9;
    if (std::abs(rolling.side_slip_rad() - gamma) > 1e-9) {
      EXPECT_TRUE(at_limit);
      ++cut;
    } else {
      ++whole;
    }
  }
  EXPECT_GT(cut, 500);
  EXPECT_GT(whole, 500);
}

TEST(SteeringLaw, ReachesTheTightestTurnOfTheReference) {
  EXPECT_NEAR(1.0 / controllers::calc_largest_curvature(kGeometry, kLimit_rad), 1.767, 5e-4);
  EXPECT_NEAR(1.0 / controllers::calc_largest_curvature(kGeometry, rad_from_deg(18.9)), 2.19, 5e-3);
}

TEST(SteeringLaw, TakesLearntSlipOffBothCommands) {
  const controllers::SteeringCommand command = controllers::steer(
      kGeometry, with_gains(0.6, 1.2), {.slip_rad = 0.03, .slip_curvature_per_m = -0.02});
  EXPECT_NEAR(command.steer_rad, -0.03, 1e-15);
  EXPECT_NEAR(command.curvature_per_m, 0.02, 1e-15);
}

TEST(SteeringLaw, AsPrintedTurnsTheRearAxleTheOtherWay) {
  controllers::SteeringParams params = with_gains(0.6, 1.2);
  const controllers::SteeringInput input{.lateral_error_m = 0.1, .heading_error_rad = -0.05};
  const AxleAngles right = controllers::steer(kGeometry, params, input).axles;
  params.form = controllers::SteeringForm::kPrinted;
  const AxleAngles printed = controllers::steer(kGeometry, params, input).axles;
  EXPECT_NEAR(printed.front_rad, right.front_rad, 1e-15);
  EXPECT_NEAR(printed.rear_rad, -right.rear_rad, 1e-15);
}

/// Drives along the x axis with exact kinematics, in steps of a millimetre.
struct Rolled {
  double lateral_m, heading_rad;
};
Rolled roll_along(const controllers::SteeringParams& params, Rolled at, double length_m) {
  const double ds = 1e-3;
  for (int i = 0; i < static_cast<int>(std::lround(length_m / ds)); ++i) {
    const controllers::SteeringCommand command = controllers::steer(
        kGeometry, params, {.lateral_error_m = at.lateral_m, .heading_error_rad = at.heading_rad});
    // Twist from the axles directly: v_y + a w = v_x tan dF, v_y - b w = v_x tan dR.
    const double front = std::tan(command.axles.front_rad), rear = std::tan(command.axles.rear_rad);
    const double w = (front - rear) / 1.5, v_y = front - 0.75 * w, speed = std::hypot(1.0, v_y);
    at.lateral_m += ds * std::sin(at.heading_rad + std::atan(v_y));
    at.heading_rad += ds * w / speed;
  }
  return at;
}

// Poles of the linear error dynamics: -K_s for the lateral error, -K_theta for the heading.
TEST(SteeringLaw, LetsSmallErrorsDieOutPerMetreDriven) {
  for (const auto& [lateral, heading] : {std::pair{0.6, 1.2}, {1.0, 2.0}, {2.0, 0.5}}) {
    const controllers::SteeringParams params = with_gains(lateral, heading);
    const double length = 2.0, small = 1e-4;
    const Rolled shifted = roll_along(params, {small, 0.0}, length);
    EXPECT_NEAR(-std::log(shifted.lateral_m / small) / length, lateral, 2e-3 * lateral);
    EXPECT_NEAR(shifted.heading_rad, 0.0, 1e-12);
    const Rolled askew = roll_along(params, {0.0, small}, length);
    EXPECT_NEAR(-std::log(askew.heading_rad / small) / length, heading, 2e-3 * heading);
    // d' = theta - K_s d driven by theta = e^(-K_theta s).
    const double expected =
        (std::exp(-heading * length) - std::exp(-lateral * length)) / (lateral - heading);
    EXPECT_NEAR(askew.lateral_m / small, expected, 2e-3);
  }
}

TEST(SteeringLaw, KeepsTheCentreOnThePathWithCourseShare) {
  controllers::SteeringParams params = with_gains(0.6, 1.2);
  params.course_share = 1.0;
  const Rolled askew = roll_along(params, {0.0, 1e-4}, 2.0);
  EXPECT_NEAR(askew.lateral_m, 0.0, 1e-9);
  EXPECT_NEAR(-std::log(askew.heading_rad / 1e-4) / 2.0, 1.2, 3e-3);
}

TEST(SteeringLaw, ComesBackFromFarOffAndWrongWay) {
  const controllers::SteeringParams params = with_gains(1.2, 2.0);
  for (const Rolled start : {Rolled{3.0, 0.0}, {-3.0, 0.5}, {0.5, -1.5}, {0.0, 3.0}}) {
    const Rolled end = roll_along(params, start, 30.0);
    EXPECT_NEAR(end.lateral_m, 0.0, 1e-3) << start.lateral_m << " " << start.heading_rad;
    EXPECT_NEAR(wrap_angle(end.heading_rad), 0.0, 1e-3);
  }
}

}  // namespace
}  // namespace vinerow::test::steering_law_test
