#include "tests/controllers/parts/solvers/linear_mpc_support.h"

#include <limits>

#include "controllers/parts/solvers/riccati.h"

namespace vinerow::test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

controllers::LinearMpcProblem double_integrator(double period_s, int horizon) {
  controllers::LinearMpcProblem problem;
  problem.A.setIdentity(2, 2);
  problem.A(0, 1) = period_s;
  problem.B.resize(2, 1);
  problem.B << 0.5 * period_s * period_s, period_s;
  problem.Q.setZero(2, 2);
  problem.R.setOnes(1, 1);
  problem.P.setZero(2, 2);
  problem.horizon = horizon;
  return problem;
}

controllers::LinearMpcProblem random_plant(RandomStream& random, int n, int m, int horizon) {
  const auto normal = [&](int rows, int columns) {
    MatrixXd result(rows, columns);
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) result(i, j) = random.normal();
    }
    return result;
  };
  controllers::LinearMpcProblem problem;
  problem.A = normal(n, n);
  problem.A *= random.uniform(0.5, 1.1) / controllers::spectral_radius(problem.A);
  problem.B = normal(n, m);
  const MatrixXd root_Q = normal(n, n), root_R = normal(m, m), root_P = normal(n, n);
  problem.Q = root_Q * root_Q.transpose();
  problem.R = root_R * root_R.transpose() + 0.1 * MatrixXd::Identity(m, m);
  problem.P = root_P * root_P.transpose();
  problem.horizon = horizon;
  return problem;
}

MpcCall::MpcCall(const controllers::LinearMpcProblem& problem)
    : x(VectorXd::Zero(problem.A.rows())),
      disturbance(x),
      input_before(VectorXd::Zero(problem.B.cols())),
      reference(MatrixXd::Zero(problem.A.rows(), problem.horizon + 1)),
      input_reference(MatrixXd::Zero(problem.B.cols(), problem.horizon)) {}

controllers::MpcStateRows box(const VectorXd& lower, const VectorXd& upper) {
  controllers::MpcStateRows rows;
  rows.F.setIdentity(lower.size(), lower.size());
  rows.lower = lower;
  rows.upper = upper;
  rows.soft_weight.setConstant(lower.size(), std::numeric_limits<double>::infinity());
  return rows;
}

}  // namespace vinerow::test
