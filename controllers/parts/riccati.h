#pragma once
/// Discrete-time algebraic Riccati and Lyapunov equations, and the LQR gain that comes of them.

#include <Eigen/Core>

#include "engine/core/result.h"

namespace vinerow {

/// The stabilising P of P = A'PA - A'PB (R + B'PB)^-1 B'PA + Q, by the structured doubling
/// algorithm (Chu, Fan, Lin, Wang, 2004). @param Q  n x n, symmetric, >= 0 @param R  m x m,
/// symmetric, > 0
/// @returns a failure in a sentence where there is none: "(A, B) cannot be stabilised: ..."
Result<Eigen::MatrixXd> solve_dare(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                                   const Eigen::MatrixXd& Q, const Eigen::MatrixXd& R);

/// K of u = -K x (m x n) for the P of solve_dare().
Eigen::MatrixXd lqr_gain(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                         const Eigen::MatrixXd& R, const Eigen::MatrixXd& P);

/// P of P = A'PA + Q. @returns a failure if A is not Schur stable, with its spectral radius
Result<Eigen::MatrixXd> solve_discrete_lyapunov(const Eigen::MatrixXd& A, const Eigen::MatrixXd& Q);

/// Largest magnitude of an eigenvalue.
double spectral_radius(const Eigen::MatrixXd& A);

}  // namespace vinerow
