#include "controllers/parts/solvers/riccati.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>

#include "engine/core/check.h"
#include "engine/math/decomposition.h"

namespace vinerow::controllers {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Doubling squares the closed loop: a solution converges long before 2^60 steps, or never.
constexpr int kMaxDoublings = 60;
// Distance to a lower rank, as a share of the matrices' size, that counts as zero.
constexpr double kRankTolerance = 1e-12;

MatrixXd symmetric(const MatrixXd& M) {
  return 0.5 * (M + M.transpose());
}

/// The eigenvalue on or outside the unit circle with the least effect of B on its mode, if that
/// effect is zero (test of Popov, Belevitch and Hautus).
std::optional<std::complex<double>> mode_out_of_reach(const MatrixXd& A, const MatrixXd& B) {
  const Index n = A.rows(), m = B.cols();
  const Eigen::VectorXcd eigenvalues = calc_eigenvalues(A);
  std::optional<std::complex<double>> found;
  double smallest = kRankTolerance * (A.norm() + B.norm());
  for (const std::complex<double>& eigenvalue : eigenvalues) {
    if (std::abs(eigenvalue) < 1.0 - 1e-9) continue;
    // [A - eigenvalue I, B]' of complex numbers as a real matrix of twice the size
    MatrixXd pencil = MatrixXd::Zero(2 * (n + m), 2 * n);
    for (const Index part : {Index{0}, Index{1}}) {
      pencil.block(part * (n + m), part * n, n, n) = A.transpose();
      pencil.block(part * (n + m), part * n, n, n).diagonal().array() -= eigenvalue.real();
      pencil.block(part * (n + m) + n, part * n, m, n) = B.transpose();
    }
    pencil.block(0, n, n, n).diagonal().setConstant(eigenvalue.imag());
    pencil.block(n + m, 0, n, n).diagonal().setConstant(-eigenvalue.imag());
    const MatrixXd triangle = pencil.colPivHouseholderQr().matrixQR();
    const double rank_margin = std::abs(triangle(2 * n - 1, 2 * n - 1));
    if (!(rank_margin < smallest)) continue;
    smallest = rank_margin;
    found = eigenvalue;
  }
  return found;
}

std::string describe(std::complex<double> eigenvalue) {
  const double imaginary = std::abs(eigenvalue.imag());
  if (imaginary < 1e-9) return fmt::format("eigenvalue {:.6g}", eigenvalue.real());
  return fmt::format("eigenvalues {:.6g} +- {:.6g}i", eigenvalue.real(), imaginary);
}

Failure why_no_solution(const MatrixXd& A, const MatrixXd& B, const MatrixXd& Q) {
  if (const auto mode = mode_out_of_reach(A, B)) {
    return {fmt::format("(A, B) cannot be stabilised: no input reaches the mode with {}",
                        describe(*mode))};
  }
  // Whether Q sees a mode depends on the directions of its rows, not on their lengths, which can
  // differ by many orders of magnitude.
  MatrixXd directions = Q;
  for (Index i = 0; i < Q.rows(); ++i) directions.row(i).stableNormalize();
  if (const auto mode = mode_out_of_reach(A.transpose(), directions.transpose())) {
    return {
        fmt::format("(A, Q) leaves an unstable mode unseen: Q gives no weight to the mode with {}",
                    describe(*mode))};
  }
  return {"the Riccati equation of (A, B, Q, R) has no stabilising solution"};
}

/// The doubling iteration: H converges to P. @returns nullopt if it does not converge
std::optional<MatrixXd> double_structure(MatrixXd A, MatrixXd G, MatrixXd H) {
  const Index n = A.rows();
  // I + G H has the best condition in units of the cost in which G and H have the same norm.
  const double size_G = G.norm(), size_H = H.norm();
  const double unit = size_G > 0.0 && size_H > 0.0 ? std::sqrt(size_H / size_G) : 1.0;
  G *= unit;
  H /= unit;
  for (int i = 0; i < kMaxDoublings; ++i) {
    const Eigen::PartialPivLU<MatrixXd> W(MatrixXd::Identity(n, n) + G * H);
    const MatrixXd W_A = W.solve(A), W_G = W.solve(G);
    const MatrixXd growth = symmetric(A.transpose() * H * W_A);
    G = symmetric(G + A * W_G * A.transpose());
    H += growth;
    A = A * W_A;
    if (!H.allFinite() || !G.allFinite() || !A.allFinite()) return std::nullopt;
    if (growth.norm() <= std::numeric_limits<double>::epsilon() * H.norm()) return unit * H;
  }
  return std::nullopt;
}

MatrixXd residual(const MatrixXd& A, const MatrixXd& B, const MatrixXd& Q, const MatrixXd& R,
                  const MatrixXd& P) {
  return A.transpose() * P * (A - B * lqr_gain(A, B, R, P)) + Q - P;
}

}  // namespace

Result<MatrixXd> solve_dare(const MatrixXd& A, const MatrixXd& B, const MatrixXd& Q,
                            const MatrixXd& R) {
  const Index n = A.rows(), m = B.cols();
  VINEROW_DEMAND(n >= 1 && A.cols() == n && B.rows() == n && m >= 1);
  VINEROW_DEMAND(Q.rows() == n && Q.cols() == n && R.rows() == m && R.cols() == m);
  if (!A.allFinite() || !B.allFinite() || !Q.allFinite() || !R.allFinite()) {
    return Failure{"A, B, Q or R contains a number that is not finite"};
  }
  const Eigen::LLT<MatrixXd> factor_R(R);
  if (factor_R.info() != Eigen::Success) return Failure{"R is not positive definite"};
  const std::optional<MatrixXd> P = double_structure(A, B * factor_R.solve(B.transpose()), Q);
  if (!P) return why_no_solution(A, B, Q);
  const MatrixXd K = lqr_gain(A, B, R, *P);
  const MatrixXd closed_loop = A - B * K;
  if (!(spectral_radius(closed_loop) < 1.0)) return why_no_solution(A, B, Q);
  const Result<MatrixXd> improved =
      solve_discrete_lyapunov(closed_loop, symmetric(Q + K.transpose() * R * K));
  const bool better =
      improved && residual(A, B, Q, R, *improved).norm() < residual(A, B, Q, R, *P).norm();
  return better ? *improved : *P;
}

MatrixXd lqr_gain(const MatrixXd& A, const MatrixXd& B, const MatrixXd& R, const MatrixXd& P) {
  const MatrixXd PB = P * B;
  return symmetric(R + B.transpose() * PB).ldlt().solve(PB.transpose() * A);
}

Result<MatrixXd> solve_discrete_lyapunov(const MatrixXd& A, const MatrixXd& Q) {
  VINEROW_DEMAND(A.rows() == A.cols() && Q.rows() == A.rows() && Q.cols() == A.cols());
  const double radius = spectral_radius(A);
  if (!(radius < 1.0)) {
    return Failure{fmt::format("A is not Schur stable: its spectral radius is {:.6g}", radius)};
  }
  MatrixXd P = Q, power = A;
  for (int i = 0; i < kMaxDoublings; ++i) {
    const MatrixXd growth = symmetric(power.transpose() * P * power);
    P += growth;
    power = power * power;
    if (growth.norm() <= 0.1 * std::numeric_limits<double>::epsilon() * P.norm()) return P;
  }
  return Failure{fmt::format("A is not Schur stable: its spectral radius is {:.17g}", radius)};
}

double spectral_radius(const MatrixXd& A) {
  VINEROW_DEMAND(A.rows() == A.cols());
  if (A.size() == 0) return 0.0;
  if (!A.allFinite()) return std::numeric_limits<double>::infinity();
  return calc_eigenvalues(A).cwiseAbs().maxCoeff();
}

}  // namespace vinerow::controllers
