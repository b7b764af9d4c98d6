/// The disturbance observer and the steady-state target, and what both are for: a linear MPC
/// without steady error.

#include "controllers/parts/disturbance_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "controllers/parts/discretise.h"
#include "controllers/parts/riccati.h"
#include "controllers/parts/steady_state_target.h"
#include "engine/core/error.h"
#include "tests/controllers/parts/linear_mpc_support.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Double integrator at 20 Hz with a force on it, the position measured.
DisturbanceModel pushed_cart() {
  MatrixXd A = MatrixXd::Zero(2, 2), B = MatrixXd::Zero(2, 2);
  A(0, 1) = 1.0;
  A(1, 1) = -0.2;
  B(1, 0) = 2.0;
  B(1, 1) = 0.5;
  const SampledModel sampled = discretise(A, B, 0.05);
  DisturbanceModel model;
  model.A = sampled.A;
  model.B = sampled.B.leftCols(1);
  model.E = sampled.B.rightCols(1);
  model.C = MatrixXd::Identity(1, 2);
  model.state_noise = VectorXd::Constant(2, 1e-3);
  model.disturbance_noise = VectorXd::Constant(1, 0.1);
  model.measurement_noise = VectorXd::Constant(1, 1e-2);
  return model;
}

TEST(DisturbanceObserver, GainOfARandomWalk) {
  // x+ = d: y is the walk d one step late. Its filter has the gain M / (M + r), M = q/2 +
  // sqrt(q^2/4 + q r).
  DisturbanceModel model;
  model.A = model.B = MatrixXd::Zero(1, 1);
  model.E = model.C = MatrixXd::Ones(1, 1);
  model.state_noise = VectorXd::Zero(1);
  model.disturbance_noise = VectorXd::Constant(1, 0.3);
  model.measurement_noise = VectorXd::Constant(1, 0.7);
  const DisturbanceObserver observer(model, "test");
  const double q = 0.09, r = 0.49, M = 0.5 * q + std::sqrt(0.25 * q * q + q * r);
  EXPECT_NEAR(observer.gain()(0, 0), M / (M + r), 1e-12);
  EXPECT_NEAR(observer.gain()(1, 0), M / (M + r), 1e-12);
  EXPECT_NEAR(observer.error_radius(), 1.0 - M / (M + r), 1e-12);
}

TEST(DisturbanceObserver, FindsWhatPushes) {
  const DisturbanceModel model = pushed_cart();
  DisturbanceObserver observer(model, "test");
  VectorXd x = Eigen::Vector2d(0.4, -0.3), u(1);
  const VectorXd d = VectorXd::Constant(1, 1.7);
  double early = 0.0, late = 0.0;
  for (int k = 0; k < 400; ++k) {
    u[0] = std::sin(0.1 * k);
    x = model.A * x + model.B * u + model.E * d;
    EXPECT_TRUE(observer.step(model.C * x, u));
    if (k == 19) early = (observer.x() - x).norm() + std::abs(observer.d()[0] - d[0]);
    if (k == 59) late = (observer.x() - x).norm() + std::abs(observer.d()[0] - d[0]);
  }
  EXPECT_GT(early, 0.01);
  // The error falls with the radius, but for the turns of a pair of complex poles.
  EXPECT_LT(late, 10.0 * early * std::pow(observer.error_radius(), 40));
  EXPECT_NEAR(observer.d()[0], d[0], 1e-10);
  EXPECT_LT((observer.x() - x).norm(), 1e-10);
  EXPECT_LT((observer.disturbance() - model.E * d).norm(), 1e-11);
}

TEST(DisturbanceObserver, PredictsThroughMissingMeasurements) {
  const DisturbanceModel model = pushed_cart();
  DisturbanceObserver observer(model, "test");
  VectorXd x = Eigen::Vector2d(0.4, -0.3), u = VectorXd::Constant(1, 0.2), d(1);
  d << -0.8;
  observer.reset(x, d);
  const VectorXd lost = VectorXd::Constant(1, kNan);
  for (int k = 0; k < 50; ++k) {
    x = model.A * x + model.B * u + model.E * d;
    EXPECT_FALSE(observer.step(lost, u));
  }
  EXPECT_LT((observer.x() - x).norm(), 1e-12);
  EXPECT_EQ(observer.d(), d);
  const VectorXd before = observer.x();
  EXPECT_FALSE(observer.step(x.head(1), lost));
  EXPECT_EQ(observer.x(), before);
}

TEST(DisturbanceObserver, StepsWithoutHeap) {
  const DisturbanceModel model = pushed_cart();
  DisturbanceObserver observer(model, "test");
  SteadyStateTarget target(model.A, model.B, model.C, "test");
  const VectorXd y = VectorXd::Ones(1), u = VectorXd::Ones(1);
  const AllocationCounter counter;
  observer.step(y, u);
  target.solve(observer.disturbance(), y);
  EXPECT_EQ(counter.count(), 0u);
}

std::string refusal(const DisturbanceModel& model) {
  try {
    const DisturbanceObserver observer(model, "drone.observer");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DisturbanceObserver, RefusesModelsInWords) {
  DisturbanceModel model = pushed_cart();
  EXPECT_EQ(refusal(model), "accepted");
  model.E = MatrixXd::Zero(3, 1);
  EXPECT_EQ(refusal(model), "drone.observer: E is 3 x 1, must be 2 x 1");
  model = pushed_cart();
  model.measurement_noise[0] = 0.0;
  EXPECT_EQ(refusal(model), "drone.observer: measurement_noise 0 = 0, must be > 0");
  model = pushed_cart();
  model.state_noise.resize(1);
  EXPECT_EQ(refusal(model), "drone.observer: state_noise has 1 numbers, must have 2");
  // Two forces on one cart, one output: Muske and Badgwell's rank.
  model = pushed_cart();
  model.E = MatrixXd::Identity(2, 2);
  model.disturbance_noise = VectorXd::Ones(2);
  EXPECT_EQ(refusal(model),
            "drone.observer: the rank of [A - I, E; C, 0] is 3, must be 4: the outputs do not tell "
            "the disturbances from the state");
  // With the speed measured only, the integrated position is not seen either.
  model = pushed_cart();
  model.C << 0.0, 1.0;
  EXPECT_EQ(refusal(model),
            "drone.observer: the rank of [A - I, E; C, 0] is 2, must be 3: the outputs do not tell "
            "the disturbances from the state");
}

TEST(SteadyStateTarget, HoldsAgainstADisturbance) {
  // x' = -a x + b u + w: x = r, u = (a r - w) / b, whatever the sample.
  const double a = 0.5, b = 2.0;
  const SampledModel model =
      discretise(MatrixXd::Constant(1, 1, -a), (MatrixXd(1, 2) << b, 1.0).finished(), 0.3);
  SteadyStateTarget target(model.A, model.B.leftCols(1), MatrixXd::Ones(1, 1), "test");
  EXPECT_TRUE(target.always_exact());
  target.solve(model.B.col(1) * 0.7, VectorXd::Constant(1, 3.0));
  EXPECT_NEAR(target.x()[0], 3.0, 1e-13);
  EXPECT_NEAR(target.u()[0], (a * 3.0 - 0.7) / b, 1e-13);
}

TEST(SteadyStateTarget, LeastErrorWhereOutputsAreMoreThanInputs) {
  // Two tanks of time constant one and gains 1 and 2 on one input: x = (u, 2u), wanted (1, 1); the
  // least square is at u = (1 + 2) / 5.
  const SampledModel model = discretise(-MatrixXd::Identity(2, 2), Eigen::Vector2d(1.0, 2.0), 0.2);
  SteadyStateTarget target(model.A, model.B, MatrixXd::Identity(2, 2), "test");
  EXPECT_FALSE(target.always_exact());
  target.solve(VectorXd::Zero(2), Eigen::Vector2d(1.0, 1.0));
  EXPECT_NEAR(target.u()[0], 0.6, 1e-12);
  EXPECT_LT((target.x() - Eigen::Vector2d(0.6, 1.2)).norm(), 1e-12);
}

TEST(SteadyStateTarget, SmallestInputsWhereSeveralDo) {
  // Two like inputs share the work; an integrator that no output reads stays at zero.
  MatrixXd A = MatrixXd::Zero(2, 2), B(2, 2);
  A(0, 0) = 0.5;
  A(1, 1) = 1.0;
  B << 1.0, 1.0, 0.0, 0.0;
  SteadyStateTarget target(A, B, MatrixXd::Identity(1, 2), "test");
  target.solve(VectorXd::Zero(2), VectorXd::Constant(1, 4.0));
  EXPECT_LT((target.x() - Eigen::Vector2d(4.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((target.u() - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-12);
  EXPECT_FALSE(target.always_exact());  // nothing holds the integrator against a disturbance
}

TEST(SteadyStateTarget, RefusesShapesThatDoNotFit) {
  try {
    SteadyStateTarget(MatrixXd::Identity(2, 2), MatrixXd::Zero(3, 1), MatrixXd::Identity(1, 2),
                      "drone.target");
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "drone.target: B is 3 x 1, must be 2 x 1 and not empty");
  }
}

/// The cart's position after 400 steps under MPC with bounds, pushed by a constant force. The plant
/// has a tenth less input gain and another drag than the model.
double rest_position(bool observed, double wanted) {
  const DisturbanceModel model = pushed_cart();
  LinearMpcProblem problem = double_integrator(0.05, 20);
  problem.A = model.A;
  problem.B = model.B;
  problem.Q = Eigen::Vector2d(10.0, 1.0).asDiagonal();
  problem.P = solve_dare(problem.A, problem.B, problem.Q, problem.R).value();
  problem.input_lower.setConstant(1, -2.0);
  problem.input_upper.setConstant(1, 2.0);
  LinearMpc mpc(problem, "test");
  DisturbanceObserver observer(model, "test");
  SteadyStateTarget target(model.A, model.B, model.C, "test");
  MpcCall call(problem);
  MatrixXd A = model.A;
  A(1, 1) -= 0.01;
  const MatrixXd B = 0.9 * model.B;
  VectorXd x = VectorXd::Zero(2);
  const VectorXd r = VectorXd::Constant(1, wanted), d = VectorXd::Constant(1, 1.7);
  for (int k = 0; k < 400; ++k) {
    call.x = x;
    if (observed) {
      observer.step(model.C * x, call.input_before);
      call.x = observer.x();
      call.disturbance = observer.disturbance();
    }
    target.solve(call.disturbance, r);
    call.reference.colwise() = target.x();
    call.input_reference.colwise() = target.u();
    EXPECT_EQ(call.solve(mpc), QpStatus::kSolved);
    call.input_before = mpc.u();
    x = A * x + B * mpc.u() + model.E * d;
  }
  return x[0];
}

TEST(OffsetFree, NoSteadyErrorWithTheObserverAndOneWithout) {
  for (const double wanted : {0.0, 1.5}) {
    EXPECT_NEAR(rest_position(true, wanted), wanted, 1e-9);
    EXPECT_GT(std::abs(rest_position(false, wanted) - wanted), 0.05);
  }
}

}  // namespace
}  // namespace vinerow::test
