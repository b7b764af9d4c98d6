#include "controllers/estimation/odometry/odometry_kalman.h"

#include <Eigen/LU>

namespace vinerow::controllers {

void OdometryKalman::start(const Eigen::Vector2d& p, const Eigen::Vector2d& std_m) {
  x_ << p, 0.0;
  covariance_.setZero();
  covariance_.diagonal() << std_m.cwiseAbs2(), params_.scale_std * params_.scale_std;
  ready_ = true;
}

void OdometryKalman::predict(const Eigen::Vector2d& d) {
  x_.head<2>() += scale() * d;
  if (params_.fixed_gain) return;
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F.topRightCorner<2, 1>() = d;
  const double distance_m = d.norm();
  const double q = params_.drift_m_per_sqrt_m, r = params_.scale_drift_per_sqrt_m;
  const Eigen::Matrix3d previous = covariance_;
  covariance_.noalias() = F * previous.lazyProduct(F.transpose());
  covariance_.diagonal() +=
      Eigen::Vector3d(q * q * distance_m, q * q * distance_m, r * r * distance_m);
}

void OdometryKalman::correct(const Eigen::Vector2d& innovation, const Eigen::Vector2d& std_m) {
  if (params_.fixed_gain) {
    x_.head<2>() += *params_.fixed_gain * innovation;
    return;
  }
  const Eigen::Matrix2d R = std_m.cwiseAbs2().asDiagonal();
  const Eigen::Matrix2d S = covariance_.topLeftCorner<2, 2>() + R;
  const Eigen::Matrix<double, 3, 2> K = covariance_.leftCols<2>() * S.inverse();
  x_ += K * innovation;
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  A.leftCols<2>() -= K;
  const Eigen::Matrix3d previous = covariance_;
  const Eigen::Matrix3d kept = A * previous * A.transpose();
  const Eigen::Matrix3d gained = K * R * K.transpose();
  covariance_ = kept + gained;
}

}  // namespace vinerow::controllers
