// Responses against the closed-loop linear model, written and sampled a second time here.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "controllers/quadrotor_mpc/quadrotor_mpc_law.h"
#include "tests/controllers/quadrotor_mpc/mpc_flight.h"

namespace vinerow::test::linear_response_test {
namespace {

constexpr int kStates = 16;
using State = Eigen::Matrix<double, kStates, 1>;
using StateMatrix = Eigen::Matrix<double, kStates, kStates>;
using InputMatrix = Eigen::Matrix<double, kStates, 4>;

/// The Q4T about hover, from its numbers, and the LQR with the controller's default weights.
struct LinearLoop {
  StateMatrix A = StateMatrix::Identity();
  InputMatrix B = InputMatrix::Zero();
  Eigen::Matrix<double, 4, kStates> K;

  explicit LinearLoop(double rotor_inertia_kgm2 = 3.6e-4) {
    const double g = 9.80665, m = 2.0, lag = 0.05, drag = 0.3, T = 0.05;
    const Eigen::Vector3d J(0.05, 0.05, 0.0977);
    StateMatrix A_c = StateMatrix::Zero();
    InputMatrix B_c = InputMatrix::Zero();
    for (int i = 0; i < 3; ++i) {
      A_c(i, 3 + i) = 1.0;
      A_c(3 + i, 3 + i) = -drag / m;
      A_c(6 + i, 9 + i) = 1.0;
      A_c(9 + i, 13 + i) = 1.0 / J(i);
    }
    A_c(3, 7) = g;
    A_c(4, 6) = -g;
    A_c(5, 12) = 1.0 / m;
    for (int i = 0; i < 4; ++i) {
      A_c(12 + i, 12 + i) = -1.0 / lag;
      B_c(12 + i, i) = 1.0 / lag;
    }
    // Spinning rotors up turns the body at once: J_r dw/dt beside k_M w^2.
    const double hover = std::sqrt(m * g / (4.0 * 5.98e-5));
    const double at_once = rotor_inertia_kgm2 / (2.0 * hover * 1.32e-6 * lag);
    A_c(11, 15) = (1.0 - at_once) / J.z();
    B_c(11, 3) = at_once / J.z();
    // Series of the exponential.
    StateMatrix term = StateMatrix::Identity();
    for (int i = 1; i < 40; ++i) {
      B += term * B_c * (T / i);
      term = term * A_c * (T / i);
      A += term;
    }
    State q;
    q << 40, 60, 120, 8, 8, 12, 4, 4, 20, 0.3, 0.3, 1, 1e-4, 1e-3, 1e-3, 1e-2;
    const Eigen::Matrix4d R = Eigen::Vector4d(0.02, 0.6, 0.6, 2).asDiagonal();
    StateMatrix P = q.asDiagonal();
    for (int i = 0; i < 5000; ++i) {
      K = (R + B.transpose() * P * B).ldlt().solve(B.transpose() * P * A);
      P = A.transpose() * P * (A - B * K);
      P += q.asDiagonal();
      P = 0.5 * (P + P.transpose()).eval();
    }
  }

  double spectral_radius() const { return (A - B * K).eigenvalues().cwiseAbs().maxCoeff(); }
};

TEST(QuadrotorMpcLinear, IsTheInfiniteHorizonLqrWhileNoLimitIsActive) {
  // Without momentum in the rotors this is the model of paper A's prototype, whose radius is .893.
  EXPECT_NEAR(LinearLoop(0.0).spectral_radius(), 0.893, 5e-4);
  const LinearLoop loop;
  EXPECT_NEAR(loop.spectral_radius(), 0.899, 5e-4);
  const controllers::RotorcraftModel craft =
      controllers::read_rotorcraft(describe(make_q4t()), 9.80665, "test");
  controllers::LinearMpc mpc(controllers::make_quadrotor_problem(
                                 craft, controllers::RotorMixer(craft, "test"), {}, "test"),
                             "test");
  State x = State::Zero(), expected;
  x.head<3>() << 0.05, -0.04, 0.03;
  x.segment<3>(3) << 0.1, 0.05, -0.1;
  x.segment<3>(6) << 0.03, -0.02, 0.01;
  x.segment<3>(9) << 0.1, 0.1, -0.05;
  expected = x;
  const Eigen::MatrixXd r = Eigen::MatrixXd::Zero(kStates, 21), v = Eigen::MatrixXd::Zero(4, 20);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(kStates), before = Eigen::VectorXd::Zero(4);
  for (int k = 0; k < 60; ++k) {
    ASSERT_EQ(mpc.solve(x, r, v, none, before), controllers::QpStatus::kSolved);
    ASSERT_EQ(mpc.soft_violation(), 0.0);
    x = (loop.A * x + loop.B * mpc.u()).eval();
    expected = ((loop.A - loop.B * loop.K) * expected).eval();
    ASSERT_LT((x - expected).norm(), 1e-8) << k;
  }
  EXPECT_LT(expected.norm(), 1e-2);
}

/// Starts a little off the reference, at rest, and compares the flight with the linear model.
void expect_linear(const Eigen::Vector3d& off_m, double yaw_rad, double heading_rad,
                   double tolerance) {
  MpcSetup setup;
  setup.path = hover_at({3, -2, 5}, heading_rad);
  setup.controller.values = {{"disturbance_s", 0.0}};
  QuadrotorLoop flight(setup);
  const Eigen::AngleAxisd heading(heading_rad, Eigen::Vector3d::UnitZ());
  flight.sim().state().p_W += heading * off_m;
  flight.sim().state().q_WB = Eigen::AngleAxisd(heading_rad + yaw_rad, Eigen::Vector3d::UnitZ());
  const LinearLoop loop;
  State x = State::Zero();
  x.head<3>() = off_m;
  x[8] = yaw_rad;
  double largest = 0.0;
  for (int k = 0; k < 60; ++k) {
    flight.tick();
    x = ((loop.A - loop.B * loop.K) * x).eval();
    largest = std::max(largest, (flight.path_error() - x.head<3>()).norm());
  }
  EXPECT_LT(largest, tolerance * off_m.norm() + 1e-4 * (yaw_rad != 0.0));
  EXPECT_LT(flight.path_error().norm(), 0.02 * off_m.norm() + 1e-6);
  EXPECT_TRUE(flight.events().empty());
}

TEST(QuadrotorMpcLinear, HoversWhereItIsLeft) {
  MpcSetup setup;
  setup.path = hover_at({1, 2, 3}, 0.8);
  QuadrotorLoop loop(setup);
  loop.run_until(5.0);
  EXPECT_LT(loop.path_error().norm(), 1e-9);
  EXPECT_LT(loop.sim().tilt_rad(), 1e-9);
}

TEST(QuadrotorMpcLinear, AnswersSmallStepsAsTheLinearModelDoes) {
  for (const double heading : {0.0, 2.0}) {
    expect_linear({0.1, 0, 0}, 0.0, heading, 0.01);
    expect_linear({0, -0.1, 0}, 0.0, heading, 0.01);
    expect_linear({0, 0, 0.1}, 0.0, heading, 0.02);
  }
}

}  // namespace
}  // namespace vinerow::test::linear_response_test
