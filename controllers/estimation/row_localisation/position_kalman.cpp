#include "controllers/estimation/row_localisation/position_kalman.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace vinerow::controllers {
namespace {

using Eigen::Matrix2d, Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d;

bool is_positive(const Matrix3d& m) {
  return m.allFinite() && Eigen::LLT<Matrix3d>(m).info() == Eigen::Success;
}

}  // namespace

// State x = (p, c), covariance P, blocks pp, pc, cc. Per step of length dt, with keep =
// exp(-dt/tau) and the velocity input v as known:
//
//   p <- p + (v + c) dt,   c <- keep c,   F = [I dt; 0 keep]
//   P <- F P F' + diag(q dt, sigma_v^2 (1 - keep^2))
// The noise of c within a step does not act on p until the next step.
//
// Measurement of f(p) at age T with gradient g: p was p - c T - (known displacement), so
// h = (g, -T g). Scalar update with innovation nu and noise R:
//
//   K = P h / (h'P h + R),   x <- x + K nu,   P <- (I - K h')P(I - K h')' + K R K'   (Joseph)

bool PositionKalman::is_sound(const Vector& x, const Matrix& P) const {
  // The block cc may be exactly zero, if the input has no slow error.
  return x.allFinite() && P.allFinite() && P.diagonal().minCoeff() >= 0.0 &&
         is_positive(P.topLeftCorner<3, 3>());
}

DatumStatus PositionKalman::accept(const Vector& x, const Matrix& P) {
  if (!is_sound(x, P)) return DatumStatus::kNotPositive;
  x_ = x;
  P_ = 0.5 * (P + P.transpose());
  return DatumStatus::kAccepted;
}

bool PositionKalman::start(Time now, const Vector3d& p_W, const Matrix3d& covariance_m2) {
  if (!p_W.allFinite() || !is_positive(covariance_m2)) return false;
  time_ = now;
  x_ << p_W, Vector3d::Zero();
  P_.setZero();
  P_.topLeftCorner<3, 3>() = covariance_m2;
  P_.bottomRightCorner<3, 3>().diagonal().setConstant(params_.velocity_std_mps *
                                                      params_.velocity_std_mps);
  has_started_ = true;
  return true;
}

DatumStatus PositionKalman::predict(Time now, const Vector3d& v_W) {
  if (now < time_) return DatumStatus::kBackwards;
  if (!v_W.allFinite()) return DatumStatus::kBadNumber;
  const double dt = std::min((now - time_).s(), params_.longest_step_s);
  time_ = now;
  const double keep = std::exp(-dt / params_.velocity_time_s);
  const double sigma2 = params_.velocity_std_mps * params_.velocity_std_mps;
  x_.head<3>() += dt * (v_W + x_.tail<3>());
  x_.tail<3>() *= keep;

  // F P F' by blocks, F = [I dt; 0 keep].
  const Matrix3d cc = P_.bottomRightCorner<3, 3>();
  const Matrix3d pc = P_.topRightCorner<3, 3>() + dt * cc;
  Matrix3d pp = P_.topLeftCorner<3, 3>() + dt * (P_.bottomLeftCorner<3, 3>() + pc);
  pp.diagonal().array() += params_.walk_m2_per_s * dt;
  P_.topLeftCorner<3, 3>() = 0.5 * (pp + pp.transpose());
  P_.topRightCorner<3, 3>() = keep * pc;
  P_.bottomLeftCorner<3, 3>() = keep * pc.transpose();
  P_.bottomRightCorner<3, 3>() = keep * keep * cc;
  P_.bottomRightCorner<3, 3>().diagonal().array() += sigma2 * (1.0 - keep * keep);
  return DatumStatus::kAccepted;
}

PositionKalman::Vector PositionKalman::gradient_of(const Vector3d& dh_dp, double age_s) {
  Vector h;
  h << dh_dp, -age_s * dh_dp;
  return h;
}

DatumStatus PositionKalman::correct(const Scalar& datum) {
  const Vector& h = datum.gradient;
  if (!std::isfinite(datum.innovation) || !h.allFinite() || !(datum.variance > 0.0) ||
      !std::isfinite(datum.variance)) {
    return DatumStatus::kBadNumber;
  }
  const Vector Ph = P_ * h;
  const double known = h.dot(Ph);
  double R = datum.variance;
  const double nis = datum.innovation * datum.innovation / (known + R);
  last_nis_ = nis;
  if (datum.gate_sigma > 0.0 && nis > datum.gate_sigma * datum.gate_sigma) {
    return DatumStatus::kGated;
  }
  if (datum.huber_sigma > 0.0 && nis > datum.huber_sigma * datum.huber_sigma) {
    // Huber's weight w = huber / |e| with e = nu / sqrt(S): S grows to S / w, so K to w K.
    R = (known + R) * std::sqrt(nis) / datum.huber_sigma - known;
  }
  const Vector K = Ph / (known + R);
  // Joseph form written out for one h: kept = (I - K h') P h.
  const Vector kept = Ph - known * K;
  const Matrix P = P_ - K * Ph.transpose() - kept * K.transpose() + R * (K * K.transpose());
  return accept(x_ + datum.innovation * K, P);
}

DatumStatus PositionKalman::correct_position(const Vector3d& innovation, const Vector3d& variance,
                                             double age_s, double gate_sigma) {
  if (!innovation.allFinite() || !variance.allFinite() || !(variance.minCoeff() > 0.0)) {
    return DatumStatus::kBadNumber;
  }
  Eigen::Matrix<double, 3, kSize> H;
  H << Matrix3d::Identity(), -age_s * Matrix3d::Identity();
  Matrix3d S = H * P_ * H.transpose();
  S.diagonal() += variance;
  const double nis = innovation.dot(S.llt().solve(innovation)) / 3.0;
  if (gate_sigma > 0.0 && nis * 3.0 > gate_sigma * gate_sigma) {
    last_nis_ = nis;
    return DatumStatus::kGated;
  }
  const Vector before = x_;
  const Matrix covariance_before = P_;
  for (int axis = 0; axis < 3; ++axis) {
    Scalar datum;
    datum.gradient = gradient_of(Vector3d::Unit(axis), age_s);
    // Minus the correction by the axes before.
    datum.innovation = innovation[axis] - datum.gradient.dot(x_ - before);
    datum.variance = variance[axis];
    if (const DatumStatus status = correct(datum); status != DatumStatus::kAccepted) {
      x_ = before;
      P_ = covariance_before;
      return status;
    }
  }
  last_nis_ = nis;
  return DatumStatus::kAccepted;
}

DatumStatus PositionKalman::correct_horizontal(const Vector2d& p, const Matrix2d& R) {
  if (!p.allFinite() || !R.allFinite()) return DatumStatus::kBadNumber;
  if (Eigen::LLT<Matrix2d>(R).info() != Eigen::Success) return DatumStatus::kNotPositive;
  // H = [I 0] on the horizontal position.
  const Eigen::Matrix<double, kSize, 2> PH = P_.leftCols<2>();
  const Matrix2d S = PH.topRows<2>() + R;
  const Eigen::Matrix<double, kSize, 2> K = PH * S.inverse();
  const Vector2d innovation = p - x_.head<2>();
  last_nis_ = 0.5 * innovation.dot(S.llt().solve(innovation));
  Matrix A = Matrix::Identity();
  A.leftCols<2>() -= K;
  return accept(x_ + K * innovation, A * P_ * A.transpose() + K * R * K.transpose());
}

DatumStatus PositionKalman::replace_horizontal(const Vector2d& p, const Matrix2d& covariance_m2) {
  if (!p.allFinite() || !covariance_m2.allFinite()) return DatumStatus::kBadNumber;
  if (Eigen::LLT<Matrix2d>(covariance_m2).info() != Eigen::Success) {
    return DatumStatus::kNotPositive;
  }
  // Jeffrey's rule: G = P H' (H P H')^-1 maps a change of the horizontal position to one of the
  // whole state; the conditional distribution of the rest stays.
  const Matrix2d before = P_.topLeftCorner<2, 2>();
  const Eigen::Matrix<double, kSize, 2> G = P_.leftCols<2>() * before.inverse();
  return accept(x_ + G * (p - x_.head<2>()), P_ + G * (covariance_m2 - before) * G.transpose());
}

void PositionKalman::widen(const Vector3d& variance_m2) {
  P_.topLeftCorner<3, 3>().diagonal() += variance_m2;
}

}  // namespace vinerow::controllers
