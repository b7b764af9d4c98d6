#include "controllers/parts/steady_state_target.h"

#include <fmt/format.h>

#include <Eigen/SVD>

#include "engine/core/check.h"
#include "engine/core/error.h"

namespace vinerow {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Singular values below this share of the largest count as zero.
constexpr double kRankTolerance = 1e-10;

void check(const std::string& who, const char* name, const MatrixXd& M, Index rows, Index columns) {
  if (M.rows() != rows || M.cols() != columns || M.size() == 0) {
    throw ConfigError(fmt::format("{}: {} is {} x {}, must be {} x {} and not empty", who, name,
                                  M.rows(), M.cols(), rows, columns));
  }
  if (!M.allFinite()) {
    throw ConfigError(fmt::format("{}: {} holds a number that is not finite", who, name));
  }
}

/// Least squares of least length, and the directions that change nothing.
struct Inverse {
  MatrixXd pseudo_inverse, null_space;
  Index rank = 0;
};

Inverse invert(const MatrixXd& M) {
  Eigen::JacobiSVD<MatrixXd> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(kRankTolerance);
  Inverse result;
  result.rank = svd.rank();
  const Index rank = result.rank;
  result.pseudo_inverse = svd.matrixV().leftCols(rank) *
                          svd.singularValues().head(rank).cwiseInverse().asDiagonal() *
                          svd.matrixU().leftCols(rank).transpose();
  result.null_space = svd.matrixV().rightCols(M.cols() - rank);
  return result;
}

}  // namespace

SteadyStateTarget::SteadyStateTarget(const MatrixXd& A, const MatrixXd& B, const MatrixXd& C,
                                     const std::string& who) {
  const Index n = A.rows(), m = B.cols(), outputs = C.rows();
  check(who, "A", A, n, n);
  check(who, "B", B, n, m);
  check(who, "C", C, outputs, n);
  MatrixXd rest(n, n + m), output = MatrixXd::Zero(outputs, n + m);
  rest << A - MatrixXd::Identity(n, n), B;
  output.leftCols(n) = C;
  // All states of rest are -pinv(rest) w + null_space t; then t for the outputs.
  const Inverse all = invert(rest);
  const MatrixXd of_t = output * all.null_space;
  Inverse best;
  best.pseudo_inverse.setZero(all.null_space.cols(), outputs);
  if (of_t.cols() > 0) best = invert(of_t);
  const MatrixXd z_of_r = all.null_space * best.pseudo_inverse;
  const MatrixXd z_of_w =
      -(MatrixXd::Identity(n + m, n + m) - z_of_r * output) * all.pseudo_inverse;
  x_of_w_ = z_of_w.topRows(n);
  u_of_w_ = z_of_w.bottomRows(m);
  x_of_r_ = z_of_r.topRows(n);
  u_of_r_ = z_of_r.bottomRows(m);
  x_.setZero(n);
  u_.setZero(m);
  always_exact_ = all.rank == n && best.rank == outputs;
}

void SteadyStateTarget::solve(const Eigen::Ref<const Eigen::VectorXd>& disturbance,
                              const Eigen::Ref<const Eigen::VectorXd>& wanted) {
  VINEROW_DEMAND(disturbance.size() == x_.size() && wanted.size() == x_of_r_.cols());
  x_.noalias() = x_of_w_ * disturbance;
  x_.noalias() += x_of_r_ * wanted;
  u_.noalias() = u_of_w_ * disturbance;
  u_.noalias() += u_of_r_ * wanted;
}

}  // namespace vinerow
