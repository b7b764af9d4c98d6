#pragma once
/// Kalman filter over east, north and the scale of the odometry, from dead reckoning and fixes.
///
/// Model: each step p += (1 + s) d + noise, with d the displacement from odometry and heading, s
/// the constant scale error of the wheels (worn tyre, steady slip) and noise of variance q^2 |d|
/// along each axis. Fix: z = p + noise of the receiver. Standard equations (Kalman 1960; Joseph
/// form of the covariance). The gain follows from the stated noise. With good odometry it falls to
/// 1/n; the estimated scale prevents such a small gain from lagging behind.

#include <Eigen/Core>
#include <optional>

namespace vinerow::controllers {

struct OdometryKalmanParams {
  double drift_m_per_sqrt_m = 0.002;  ///< q
  double scale_std = 0.03;            ///< of s at the start
  double scale_drift_per_sqrt_m = 1e-4;
  std::optional<double> fixed_gain;  ///< on the position; the scale is not estimated
};

class OdometryKalman {
 public:
  explicit OdometryKalman(const OdometryKalmanParams& params) : params_(params) {}

  bool ready() const { return ready_; }
  void start(const Eigen::Vector2d& p, const Eigen::Vector2d& std_m);
  /// @param d  displacement of the odometry, m, in W
  void predict(const Eigen::Vector2d& d);
  /// @param innovation  fix minus the estimate at the time of the fix, m
  /// @param std_m  1 sigma of the fix, > 0
  void correct(const Eigen::Vector2d& innovation, const Eigen::Vector2d& std_m);

  Eigen::Vector2d p() const { return x_.head<2>(); }
  double scale() const { return 1.0 + x_[2]; }
  Eigen::Vector2d std_m() const { return covariance_.diagonal().head<2>().cwiseSqrt(); }
  const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  OdometryKalmanParams params_;
  bool ready_ = false;
  Eigen::Vector3d x_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace vinerow::controllers
