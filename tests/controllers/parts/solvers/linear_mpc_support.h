#pragma once
/// Problems that the tests of the linear MPC share.

#include <Eigen/Core>

#include "controllers/parts/solvers/linear_mpc.h"
#include "engine/core/random.h"

namespace vinerow::test {

/// x+ = x + v T + u T^2/2, v+ = v + u T; Q, R, P zero but for R = 1.
controllers::LinearMpcProblem double_integrator(double period_s, int horizon);

/// A random system of n states and m inputs, about as fast as the sample, Q, R and P positive.
controllers::LinearMpcProblem random_plant(RandomStream& random, int n, int m, int horizon);

/// Reference and the like that are constant or zero.
struct MpcCall {
  explicit MpcCall(const controllers::LinearMpcProblem& problem);
  controllers::QpStatus solve(controllers::LinearMpc& mpc) const {
    return mpc.solve(x, reference, input_reference, disturbance, input_before);
  }
  Eigen::VectorXd x, disturbance, input_before;
  Eigen::MatrixXd reference, input_reference;
};

/// Rows of all states, hard.
controllers::MpcStateRows box(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

}  // namespace vinerow::test
