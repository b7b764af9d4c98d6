#include "controllers/parts/solvers/discretise.h"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "engine/core/check.h"

namespace vinerow::controllers {

SampledModel discretise(const Eigen::MatrixXd& A_c, const Eigen::MatrixXd& B_c, double period_s) {
  const Eigen::Index n = A_c.rows(), m = B_c.cols();
  VINEROW_DEMAND(n >= 1 && A_c.cols() == n && B_c.rows() == n);
  VINEROW_DEMAND(A_c.allFinite() && B_c.allFinite() && period_s > 0.0);
  // The exponential is halved and squared until the largest entry is small. Large entries of B,
  // which depend on units only, would cause A to be squared more often than necessary and lose
  // digits. So B is divided by a power of two first.
  const double size_A = std::max(1.0, period_s * A_c.lpNorm<Eigen::Infinity>());
  const double size_B = m == 0 ? 0.0 : period_s * B_c.lpNorm<Eigen::Infinity>();
  const int exponent = size_B > size_A ? std::ilogb(size_B / size_A) + 1 : 0;
  Eigen::MatrixXd generator = Eigen::MatrixXd::Zero(n + m, n + m);
  generator.topLeftCorner(n, n) = period_s * A_c;
  generator.topRightCorner(n, m) = std::ldexp(period_s, -exponent) * B_c;
  const Eigen::MatrixXd held = generator.exp();
  return {held.topLeftCorner(n, n), std::ldexp(1.0, exponent) * held.topRightCorner(n, m)};
}

}  // namespace vinerow::controllers
