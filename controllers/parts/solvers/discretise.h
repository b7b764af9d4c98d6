#pragma once
/// Conversion of continuous to sampled linear models.

#include <Eigen/Core>

namespace vinerow::controllers {

struct SampledModel {
  Eigen::MatrixXd A;
  Eigen::MatrixXd B;
};

/// Zero-order hold: x+ = A x + B u for inputs held over `period_s`, by the matrix exponential of
/// [A_c B_c; 0 0]. Several inputs, e.g. controls and disturbances, can share B_c side by side.
/// Source: Van Loan, "Computing integrals involving the matrix exponential", IEEE TAC 23(3), 1978.
/// @param A_c  n x n  @param B_c  n x m  @param period_s  > 0
/// @pre the sizes fit and all numbers are finite
SampledModel discretise(const Eigen::MatrixXd& A_c, const Eigen::MatrixXd& B_c, double period_s);

}  // namespace vinerow::controllers
