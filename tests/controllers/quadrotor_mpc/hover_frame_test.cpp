// What flight laws share: the frame of the wanted heading, the rotors' prediction, the observer.

#include "controllers/parts/rotorcraft/hover_frame.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "controllers/parts/rotorcraft/flight_disturbance.h"
#include "controllers/parts/rotorcraft/rotor_prediction.h"
#include "tests/controllers/support/quadrotor_sim.h"

namespace vinerow::test::hover_frame_test {
namespace {

controllers::RotorcraftModel q4t() {
  return controllers::read_rotorcraft(describe(make_q4t()), 9.80665, "test");
}

Odometry turned(double roll, double pitch, double yaw) {
  Odometry odometry;
  odometry.X_WB.q = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                    Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  return odometry;
}

TEST(HoverFrame, SeesPlaceAndVelocityAlongTheWantedHeading) {
  const controllers::HoverFrame frame({10, 20, 5}, M_PI / 6.0);
  Odometry odometry = turned(0, 0, M_PI / 6.0);
  odometry.X_WB.p = {10.0 + std::cos(M_PI / 6.0), 20.0 + std::sin(M_PI / 6.0), 4.0};
  odometry.v_WB_B = {3.0, 0.5, 0.25};
  const controllers::HoverState state = controllers::calc_hover_state(odometry, frame);
  EXPECT_LT((state.x.head<6>() - Eigen::Matrix<double, 6, 1>{1, 0, -1, 3, 0.5, 0.25}).norm(),
            1e-12);
  EXPECT_LT(state.x.tail<6>().norm(), 1e-12);
  EXPECT_NEAR(state.upright, 1.0, 1e-15);
}

// The thrust of a body that leans must push where the model says: g (tan pitch, -tan roll).
TEST(HoverFrame, TakesTiltFromTheDirectionOfThrustWhateverTheYaw) {
  for (const double yaw : {0.0, 0.4, -2.5}) {
    const controllers::HoverFrame frame({0, 0, 0}, 0.7);
    const Odometry odometry = turned(0.3, -0.25, 0.7 + yaw);
    const controllers::HoverState state = controllers::calc_hover_state(odometry, frame);
    const Eigen::Vector3d z_W = odometry.X_WB.q * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d push = frame.from_W(z_W / z_W.z());
    EXPECT_NEAR(std::tan(state.x[controllers::kHoverAngle + 1]), push.x(), 1e-12);
    EXPECT_NEAR(-std::tan(state.x[controllers::kHoverAngle]), push.y(), 1e-12);
    EXPECT_NEAR(std::cos(state.tilt_rad()), z_W.z(), 1e-12);
    if (yaw == 0.0) {
      EXPECT_NEAR(state.x[controllers::kHoverAngle + 1], -0.25, 0.013);
    }
    EXPECT_NEAR(state.x[controllers::kHoverAngle + 2], yaw, 1e-12);
  }
}

TEST(HoverFrame, GivesTheRatesOfItsAngles) {
  const controllers::HoverFrame frame({0, 0, 0}, -0.4);
  Odometry now = turned(0.4, -0.3, 0.5);
  now.w_WB_B = {0.8, -1.1, 0.6};
  const double dt = 1e-6;
  const auto at = [&](double time_s) {
    Odometry moved = now;
    moved.X_WB.q = now.X_WB.q * Eigen::Quaterniond(Eigen::AngleAxisd(time_s * now.w_WB_B.norm(),
                                                                     now.w_WB_B.normalized()));
    return controllers::calc_hover_state(moved, frame).x;
  };
  const Eigen::Vector2d rates =
      (at(dt) - at(-dt)).segment<2>(controllers::kHoverAngle) / (2.0 * dt);
  EXPECT_LT((at(0.0).segment<2>(controllers::kHoverRate) - rates).norm(), 1e-8);
  // The third is the rate about the vertical.
  EXPECT_NEAR(at(0.0)[controllers::kHoverRate + 2], (now.X_WB.q * now.w_WB_B).z(), 1e-12);
}

TEST(HoverFrame, TurnsWrenchesForthAndBack) {
  const controllers::HoverState state =
      controllers::calc_hover_state(turned(0.2, 0.3, 0.9), controllers::HoverFrame({0, 0, 0}, 0.4));
  const Eigen::Vector4d u(1.5, 0.3, -0.2, 0.1);
  const controllers::Wrench wrench = controllers::calc_body_wrench(u, state, 20.0);
  EXPECT_NEAR(wrench.thrust_N * state.upright, 21.5, 1e-12);
  // The body looks 0.5 rad to the left of H, so H's x torque is partly a negative y torque in B.
  EXPECT_NEAR(wrench.torque_B.x(), 0.3 * std::cos(0.5) - 0.2 * std::sin(0.5), 1e-3);
  EXPECT_LT((controllers::calc_hover_wrench(wrench, state, 20.0) - u).norm(), 1e-12);
  // Lying on the side it does not ask for endless thrust, head down for none.
  EXPECT_NEAR(
      controllers::calc_body_wrench(
          u,
          controllers::calc_hover_state(turned(1.5, 0, 0), controllers::HoverFrame({0, 0, 0}, 0)),
          20)
          .thrust_N,
      43.0, 1e-12);
  EXPECT_EQ(
      controllers::calc_body_wrench(
          u, controllers::calc_hover_state(turned(2, 0, 0), controllers::HoverFrame({0, 0, 0}, 0)),
          20)
          .thrust_N,
      0.0);
}

TEST(RotorPrediction, FollowsTheLagAndItsMeanThrust) {
  const controllers::RotorcraftModel craft = q4t();
  const controllers::RotorMixer mixer(craft, "test");
  controllers::RotorPrediction rotors(craft, mixer);
  const std::vector<double> start = {100, 200, 300, 400}, wanted = {500, 250, 100, 0};
  rotors.set_speeds(start);
  rotors.command(wanted, 0.05);
  // Speeds and the mean of their squares by many small steps.
  std::vector<double> speed = start, mean(4, 0.0), square(4, 0.0);
  constexpr int kSteps = 200'000;
  for (int i = 0; i < kSteps; ++i) {
    for (std::size_t r = 0; r < 4; ++r) {
      const double half = speed[r] + 0.5 * (0.05 / kSteps) * (wanted[r] - speed[r]) / 0.05;
      square[r] += half * half / kSteps;
      speed[r] += (0.05 / kSteps) * (wanted[r] - half) / 0.05;
    }
  }
  for (std::size_t r = 0; r < 4; ++r) mean[r] = std::sqrt(square[r]);
  EXPECT_NEAR(rotors.now().thrust_N, mixer.wrench_of(speed).thrust_N, 1e-6);
  EXPECT_LT((rotors.now().torque_B - mixer.wrench_of(speed).torque_B).norm(), 1e-6);
  EXPECT_NEAR(rotors.mean().thrust_N, mixer.wrench_of(mean).thrust_N, 1e-6);
  // With it the momentum that went into the rotors, which came out of the body.
  Eigen::Vector3d torque = mixer.wrench_of(mean).torque_B;
  for (std::size_t r = 0; r < 4; ++r) {
    torque.z() += craft.rotors[r].torque_sign * 3.6e-4 * (speed[r] - start[r]) / 0.05;
  }
  EXPECT_GT(std::abs(torque.z() - mixer.wrench_of(mean).torque_B.z()), 1.0);
  EXPECT_LT((rotors.mean().torque_B - torque).norm(), 1e-6);
}

/// A vehicle that is pushed by `force_W` and turned by `torque_B`, held up by its weight as thrust,
/// while it yaws.
controllers::FlightDisturbance learn(double time_s, double seconds, bool torques = true) {
  const controllers::RotorcraftModel craft = q4t();
  controllers::FlightDisturbance disturbance(craft, time_s, torques, 0.05);
  const double weight_N = craft.mass_kg * craft.gravity_mps2;
  const Eigen::Vector3d force_W(1.2, -0.4, 0.6), torque_B(0.02, 0.01, -0.03);
  Eigen::Vector3d v_W(0, 0, 0), w_B(0, 0, 0);
  for (int i = 0; i * 0.05 <= seconds + 1e-9; ++i) {
    Odometry odometry = turned(0, 0, 0.3 * i);
    odometry.v_WB_B = odometry.X_WB.q.conjugate() * v_W;
    odometry.w_WB_B = w_B;
    // Euler's equations by the implicit midpoint.
    Eigen::Vector3d next_w = w_B;
    for (int n = 0; n < 20; ++n) {
      const Eigen::Vector3d w = 0.5 * (w_B + next_w), J = craft.inertia_kgm2;
      next_w = w_B + 0.05 * (torque_B - w.cross(J.cwiseProduct(w))).cwiseQuotient(J);
    }
    disturbance.update(odometry, {weight_N, {0, 0, 0}}, true);
    // Drag by the mean speed of the step.
    const double k = craft.rotor_drag_Ns_per_m / craft.mass_kg;
    const Eigen::Vector3d a = force_W / craft.mass_kg;
    v_W = ((1.0 - 0.025 * k) * v_W + 0.05 * a) / (1.0 + 0.025 * k);
    w_B = next_w;
  }
  return disturbance;
}

TEST(FlightDisturbance, LearnsAForceInItsTimeThoughTheVehicleTurns) {
  const controllers::FlightDisturbance learnt = learn(0.3, 3.0);
  EXPECT_LT((learnt.acceleration_W() - Eigen::Vector3d(0.6, -0.2, 0.3)).norm(), 1e-4);
  // After one time constant 1 - 1/e of it, after the first estimate nothing.
  EXPECT_NEAR(learn(0.3, 0.3).acceleration_W().x(), 0.6 * (1.0 - std::exp(-1.0)), 1e-9);
  EXPECT_EQ(learn(0.3, 0.0).acceleration_W().norm(), 0.0);
  EXPECT_EQ(learn(0.0, 3.0).acceleration_W().norm(), 0.0);
}

TEST(FlightDisturbance, LearnsATorqueIfItMay) {
  const Eigen::Vector3d expected =
      Eigen::Vector3d(0.02, 0.01, -0.03).cwiseQuotient(q4t().inertia_kgm2);
  EXPECT_LT((learn(0.1, 1.0).angular_B() - expected).norm(), 1e-4 * expected.norm());
  EXPECT_EQ(learn(0.1, 1.0, false).angular_B().norm(), 0.0);
}

TEST(FlightDisturbance, IsNeverMoreThanTheVehicleCouldCarry) {
  controllers::FlightDisturbance disturbance(q4t(), 0.01, true, 0.05);
  Odometry odometry;
  for (int i = 0; i < 50; ++i) {
    odometry.v_WB_B = {100.0 * i, 0, 0};
    odometry.w_WB_B = {100.0 * i, 0, 0};
    disturbance.update(odometry, {0.0, {0, 0, 0}}, true);
  }
  EXPECT_NEAR(disturbance.acceleration_W().x(), 0.5 * 9.80665, 1e-12);
  EXPECT_NEAR(disturbance.angular_B().x(), 20.0, 1e-12);
  disturbance.reset();
  EXPECT_EQ(disturbance.acceleration_W().norm(), 0.0);
}

}  // namespace
}  // namespace vinerow::test::hover_frame_test
