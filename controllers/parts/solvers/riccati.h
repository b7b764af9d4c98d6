#pragma once
/// Discrete-time algebraic Riccati and Lyapunov equations, and the LQR gain derived from them.
/// All functions allocate: for set-up, not for a step.

#include <Eigen/Core>

#include "engine/core/result.h"

namespace vinerow::controllers {

/// The stabilising P of P = A'PA - A'PB (R + B'PB)^-1 B'PA + Q, by the structured doubling
/// algorithm and one step of Newton's method for the last digits.
/// Sources: Chu, Fan, Lin, Wang, "Structure-preserving algorithms for periodic discrete-time
/// algebraic Riccati equations", Int. J. Control 77(8), 2004; Kleinman, IEEE TAC 13(1), 1968.
/// @param A  n x n  @param B  n x m  @param Q  n x n, symmetric, >= 0
/// @param R  m x m, symmetric, > 0
/// @returns a failure in a sentence if no solution exists: "(A, B) cannot be stabilised: ..."; also
/// if an unstable mode has no weight in Q, "(A, Q) leaves an unstable mode unseen: ..."
/// @pre the sizes fit
Result<Eigen::MatrixXd> solve_dare(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                                   const Eigen::MatrixXd& Q, const Eigen::MatrixXd& R);

/// K of u = -K x (m x n) for the P of solve_dare().
Eigen::MatrixXd lqr_gain(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                         const Eigen::MatrixXd& R, const Eigen::MatrixXd& P);

/// P of P = A'PA + Q, by doubling (Smith, "Matrix equation XA + BX = C", SIAM J. Appl. Math. 16(1),
/// 1968). @param Q  n x n, symmetric. @returns a failure if A is not Schur stable, with its
/// spectral radius
Result<Eigen::MatrixXd> solve_discrete_lyapunov(const Eigen::MatrixXd& A, const Eigen::MatrixXd& Q);

/// Largest magnitude of an eigenvalue; infinite if a number of A is not finite.
double spectral_radius(const Eigen::MatrixXd& A);

}  // namespace vinerow::controllers
