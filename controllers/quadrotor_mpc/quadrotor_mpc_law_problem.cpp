// The problem of quadrotor_mpc_law.h, from model and parameters.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/solvers/discretise.h"
#include "controllers/parts/solvers/riccati.h"
#include "controllers/quadrotor_mpc/quadrotor_mpc_law.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr int kStates = HoverModel::kStatesWithLag;
// The weights apply per tick of this length.
constexpr double kWeightPeriod_s = 0.05;

Eigen::MatrixXd make_state_weight(const MpcWeights& weights) {
  // The acting wrench has a tiny weight: enough to make Q positive definite.
  const Eigen::Vector4d wrench(1e-4, 1e-3, 1e-3, 1e-2);
  Eigen::VectorXd diagonal(kStates);
  diagonal << weights.position, weights.velocity, weights.angle, weights.rate, wrench;
  return diagonal.asDiagonal();
}

MpcStateRows make_soft_rows(const Eigen::MatrixXd& F, const Eigen::VectorXd& limit, double weight) {
  return {F, -limit, limit, Eigen::VectorXd::Constant(limit.size(), weight), false};
}

/// The octagon inside the circle of the largest tilt: roll, pitch and their diagonals.
MpcStateRows make_tilt_rows(double max_tilt_rad, double weight) {
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(4, kStates);
  for (int i = 0; i < 4; ++i) {
    F(i, kHoverAngle) = std::cos(0.25 * kPi * i);
    F(i, kHoverAngle + 1) = std::sin(0.25 * kPi * i);
  }
  return make_soft_rows(F, Eigen::Vector4d::Constant(std::cos(kPi / 8.0) * max_tilt_rad), weight);
}

MpcStateRows make_deviation_rows(const MpcLimits& limits, double weight) {
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(3, kStates);
  F(0, kHoverPosition + 1) = 1.0;
  F(1, kHoverPosition + 2) = 1.0;
  F(2, kHoverVelocity) = 1.0;
  MpcStateRows rows = make_soft_rows(
      F, Eigen::Vector3d(limits.lateral_m, limits.altitude_m, limits.speed_mps), weight);
  rows.relative = true;
  return rows;
}

void set_input_limits(const RotorcraftModel& craft, const RotorMixer& mixer,
                      const QuadrotorMpcParams& params, LinearMpcProblem& problem) {
  const double weight_N = craft.mass_kg * craft.gravity_mps2;
  const Eigen::Vector3d torque = params.torque_share * mixer.torque_limits_at_hover();
  const double max_N = std::min(params.max_thrust * weight_N, craft.max_thrust_N());
  problem.input_lower.resize(HoverModel::kInputs);
  problem.input_upper.resize(HoverModel::kInputs);
  problem.input_lower << (params.min_thrust - 1.0) * weight_N, -torque;
  problem.input_upper << max_N - weight_N, torque;
}

}  // namespace

LinearMpcProblem make_quadrotor_problem(const RotorcraftModel& craft, const RotorMixer& mixer,
                                        const QuadrotorMpcParams& params, const std::string& who) {
  const HoverModel model = make_hover_model(craft, true);
  const SampledModel sampled = discretise(model.A, model.B, params.period_s);
  const double scale = params.period_s / kWeightPeriod_s;
  LinearMpcProblem problem;
  problem.A = sampled.A;
  problem.B = sampled.B;
  problem.Q = scale * make_state_weight(params.weights);
  problem.R = (scale * params.weights.input).asDiagonal();
  const Result<Eigen::MatrixXd> P = solve_dare(problem.A, problem.B, problem.Q, problem.R);
  if (!P) throw ConfigError(fmt::format("{}: no terminal weight: {}", who, P.reason()));
  problem.P = *P;
  problem.horizon = params.horizon;
  set_input_limits(craft, mixer, params, problem);

  problem.state_rows = {make_tilt_rows(params.limits.tilt_rad, scale * params.tilt_weight),
                        make_deviation_rows(params.limits, scale * params.deviation_weight)};
  return problem;
}

}  // namespace vinerow::controllers
