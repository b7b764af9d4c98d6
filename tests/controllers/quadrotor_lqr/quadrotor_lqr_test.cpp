#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "controllers/parts/solvers/discretise.h"
#include "controllers/quadrotor_lqr/quadrotor_lqr.h"
#include "controllers/quadrotor_lqr/quadrotor_lqr_law.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/quadrotor_loop.h"

namespace vinerow::test::quadrotor_lqr_test {
namespace {

controllers::FlightLimits wide_limits() {
  controllers::FlightLimits limits;
  limits.tilt_rad = 1.0;
  limits.max_thrust_N = 1e3;
  limits.torque_Nm.setConstant(1e3);
  limits.correction_mps = limits.climb_correction_mps = limits.yaw_rate_radps = 1e3;
  return limits;
}

struct Law {
  explicit Law(const QuadrotorNumbers& numbers, const controllers::LqrParams& p = {},
               const controllers::FlightLimits& limits = wide_limits())
      : craft(controllers::read_rotorcraft(describe(numbers), 9.80665, "test")),
        mixer(craft, "test"),
        params(p),
        law(craft, mixer, limits, p, "test") {}
  controllers::RotorcraftModel craft;
  controllers::RotorMixer mixer;
  controllers::LqrParams params;
  controllers::QuadrotorLqrLaw law;
};

/// Weights as the law documents them.
void make_weights(const Law& law, Eigen::MatrixXd& Q, Eigen::MatrixXd& R) {
  const controllers::LqrParams& p = law.params;
  Eigen::VectorXd q(16);
  q << p.position_per_m2.x(), p.position_per_m2.x(), p.position_per_m2.y(), p.velocity_per_mps2.x(),
      p.velocity_per_mps2.x(), p.velocity_per_mps2.y(), p.angle_per_rad2.x(), p.angle_per_rad2.x(),
      p.angle_per_rad2.y(), p.rate_per_radps2.x(), p.rate_per_radps2.x(), p.rate_per_radps2.y(), 0,
      0, 0, 0;
  Eigen::Vector4d r(p.thrust_weight, p.torque_weight.x(), p.torque_weight.x(), p.torque_weight.y());
  const Eigen::Vector4d inertia(law.craft.mass_kg, law.craft.inertia_kgm2.x(),
                                law.craft.inertia_kgm2.y(), law.craft.inertia_kgm2.z());
  Q = q.asDiagonal();
  R = r.cwiseQuotient(inertia.cwiseAbs2()).asDiagonal();
}

// Dynamic programming backwards from the horizon, without the Riccati solver of the product.
TEST(QuadrotorLqr, HasTheGainOfALongFiniteHorizon) {
  for (const QuadrotorNumbers& numbers : {make_q4t(), make_m100()}) {
    const Law law(numbers);
    const controllers::HoverModel model = controllers::make_hover_model(law.craft, true);
    const controllers::SampledModel m =
        controllers::discretise(model.A, model.B, law.params.period_s);
    Eigen::MatrixXd Q, R;
    make_weights(law, Q, R);
    Eigen::MatrixXd P = Q, K;
    for (int i = 0; i < 3000; ++i) {
      K = (R + m.B.transpose() * P * m.B).ldlt().solve(m.B.transpose() * P * m.A);
      P = m.A.transpose() * P * (m.A - m.B * K) + Q;
      P = 0.5 * (P + Eigen::MatrixXd(P.transpose()));
    }
    // The law gives the wrench states a weight of 1e-6 so that none is free.
    EXPECT_LT((law.law.gain() - K).norm(), 1e-4 * K.norm());
    const Eigen::MatrixXd closed = m.A - m.B * law.law.gain();
    EXPECT_LT(closed.eigenvalues().cwiseAbs().maxCoeff(), 0.98);
  }
}

TEST(QuadrotorLqr, GivesVehiclesOfAnySizeTheSameLoop) {
  QuadrotorNumbers small = make_q4t(), large = small;
  large.mass_kg *= 3.0;
  large.inertia_kgm2 = {0.4, 0.3, 0.9};
  large.thrust_coefficient *= 3.0;
  large.torque_coefficient *= 3.0;
  large.rotor_inertia_kgm2 *= 3.0;
  large.rotor_drag_Ns_per_m *= 3.0;
  const Law a(small), b(large);
  const Eigen::Vector4d ratio(3.0, 0.4 / 0.05, 0.3 / 0.05, 0.9 / 0.0977);
  const Eigen::MatrixXd scaled = ratio.asDiagonal() * a.law.gain().leftCols(12);
  EXPECT_LT((b.law.gain().leftCols(12) - scaled).norm(), 1e-9 * scaled.norm());
}

TEST(QuadrotorLqr, IsExactlyLinearInsideItsLimits) {
  Law law(make_q4t());
  law.law.reset(true);
  TrajectoryPoint at;
  at.p_W = {1, 2, 3};
  Odometry odometry;
  const double yaw = 0.0, pitch = 0.02, roll = -0.03;
  odometry.X_WB.p = at.p_W + Eigen::Vector3d(0.02, -0.01, 0.03);
  odometry.X_WB.q = quaternion_from_rpy({roll, pitch, yaw});
  odometry.v_WB_B = odometry.X_WB.q.conjugate() * Eigen::Vector3d(0.05, 0.02, -0.04);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(16);
  x << 0.02, -0.01, 0.03, 0.05, 0.02, -0.04, roll, pitch, yaw, 0, 0, 0, 0, 0, 0, 0;
  // In H the tilts are arc tangents of the thrust's direction: differences of third order.
  const Eigen::Vector4d u = -law.law.gain() * x;
  const controllers::Wrench wanted = law.law.step(at, odometry, true);
  EXPECT_LT((wanted.torque_B - u.tail<3>()).norm(), 2e-3 * u.tail<3>().norm());
  EXPECT_NEAR(wanted.thrust_N - 2.0 * 9.80665, u(0), 0.02);
}

TEST(QuadrotorLqr, LeavesNothingToTheGainOnAFeasibleReference) {
  // A steady circle: the vehicle that leans and turns as it must gets torques for nothing but the
  // turn's gyroscopic part, and the thrust that holds the lean.
  Law law(make_q4t());
  law.law.reset(true);
  const double speed = 1.6, radius = 2.0, rate = speed / radius, drag = 0.3 / 2.0;
  TrajectoryPoint at;
  at.v_W = {speed, 0, 0};
  at.a_W = {0, speed * rate, 0};
  at.yaw_rate_radps = rate;
  const Eigen::Vector3d push(drag * speed, speed * rate, 9.80665);
  const Eigen::Vector3d z = push.normalized(), x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Odometry odometry;
  Eigen::Matrix3d R_WB;
  R_WB << x, z.cross(x), z;
  odometry.X_WB.q = Eigen::Quaterniond(R_WB);
  odometry.v_WB_B = R_WB.transpose() * at.v_W;
  const controllers::Wrench wanted = law.law.step(at, odometry, true);
  EXPECT_NEAR(wanted.thrust_N, 2.0 * push.norm(), 0.01 * 2.0 * 9.80665);
  EXPECT_LT(wanted.torque_B.head<2>().norm(), 0.35);  // of 60: rates of a turning lean are not fed
}

TEST(QuadrotorLqr, StepsAsItsLinearModelDoes) {
  // A step of 1 cm in the nonlinear vehicle against x+ = (A - B K) x of the sampled model.
  const QuadrotorNumbers numbers = make_q4t();
  const Law law(numbers);
  const controllers::HoverModel model = controllers::make_hover_model(law.craft, true);
  const controllers::SampledModel m =
      controllers::discretise(model.A, model.B, law.params.period_s);
  QuadrotorSetup setup;
  setup.controller = {"quadrotor_lqr", {{"disturbance_s", 0.0}}};
  setup.guidance_rate_Hz = 50.0;
  setup.start.p = {0, 0, 2};
  const double step_m = 0.01;
  setup.path = hover_at({step_m, 0.5 * step_m, 2 + step_m});
  QuadrotorLoop loop(setup);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(16);
  x.head<3>() << -step_m, -0.5 * step_m, -step_m;
  double worst_m = 0.0;
  for (int i = 0; i < 150; ++i) {
    worst_m = std::max(worst_m, (loop.path_error() - x.head<3>()).norm());
    loop.run_until(0.02 * (i + 1));
    x = (m.A - m.B * law.law.gain()) * x;
  }
  EXPECT_LT(worst_m, 0.01 * step_m);
  EXPECT_LT(x.head<3>().norm(), 0.01 * step_m);
}

TEST(QuadrotorLqr, ObserverTakesAwayWhatAWindLeaves) {
  QuadrotorSetup setup;
  setup.start.p = {0, 0, 2};
  setup.path = hover_at(setup.start.p);
  setup.wind = [](double, const Eigen::Vector3d&) { return Eigen::Vector3d(0, 3, 0); };
  // Drag of 3 m/s against the stiffness of the loop, K_position / K_tilt rad per metre.
  setup.controller = {"quadrotor_lqr", {{"disturbance_s", 0.0}}};
  QuadrotorLoop without(setup);
  without.run_until(15.0);
  const Law law(setup.numbers);
  const Eigen::MatrixXd& K = law.law.gain();
  const double drag_N = 3.0 * (0.3 + 0.5 * 1.225 * 0.04 * 3.0);
  const double stiffness = K(1, 1) / -K(1, 6);  // the wind's tilt, pushed back by y
  const double expected_m = std::atan(drag_N / (2.0 * 9.80665)) / std::abs(stiffness);
  EXPECT_NEAR(without.path_error().y(), expected_m, 0.03 * expected_m);
  setup.controller.values.clear();
  QuadrotorLoop with(setup);
  with.run_until(15.0);
  EXPECT_LT(with.path_error().norm(), 1e-6);
}

TEST(QuadrotorLqr, CutsTheWantedTilt) {
  controllers::FlightLimits limits = wide_limits();
  limits.tilt_rad = 0.2;
  Law law(make_q4t(), {}, limits);
  law.law.reset(true);
  // Far off, leaning as far as allowed towards the goal: no torque wants more.
  TrajectoryPoint at;
  at.p_W = {50, 0, 0};
  Odometry odometry;
  odometry.X_WB.q = quaternion_from_rpy({0, 0.2, 0});
  EXPECT_NEAR(law.law.step(at, odometry, true).torque_B.norm(), 0.0, 1e-9);
}

TEST(QuadrotorLqr, RefusesWeightsWithoutAGain) {
  const PartSpec spec = controllers::quadrotor_lqr_spec();
  ParameterSet parameters(spec.parameters, spec.name);
  EXPECT_THROW(parameters.set("position_weight", std::vector<double>{0.0, 1.0}), ConfigError);
  EXPECT_THROW(parameters.set("thrust_weight", 0.0), ConfigError);
  EXPECT_THROW(parameters.set("torque_weight", std::vector<double>{1.0}), ConfigError);
  EXPECT_NO_THROW(parameters.set("velocity_weight", std::vector<double>{0.0, 0.0}));
}

}  // namespace
}  // namespace vinerow::test::quadrotor_lqr_test
