#pragma once
/// One hypothesis about a vehicle's position on a map of rows: an extended Kalman filter on
/// position, slow errors of velocity, heading and satellite fixes, and the shift of the map.
///
/// The velocity of the inertial unit drives the process model: p' = v - b, with b its slow error.
/// The velocity error, the heading error and the common error of the fixes are first-order
/// Gauss-Markov processes; the map's shift is constant. All errors are in W (m, m/s, rad). Source
/// of the range measurement: docs/papers/localisation.md.

#include <Eigen/Core>

#include "engine/math/angles.h"

namespace vinerow::controllers {

/// Slow error: standard deviation and correlation time. A standard deviation of zero leaves the
/// error out.
struct SlowError {
  double std = 0.0;
  double time_s = 60.0;
};

struct LocalisationNoise {
  double velocity_density_m_rts = 0.003;           ///< white error of the velocity, m/sqrt(s)
  SlowError velocity_mps{0.05, 5.0};               ///< each axis
  SlowError heading_rad{rad_from_deg(0.2), 60.0};  ///< slow part of the heading error
  SlowError fix_horizontal_m{0.7, 60.0};           ///< slow part of the fixes' error
  SlowError fix_vertical_m{1.05, 60.0};
};

class LocalisationState {
 public:
  enum Index { kPosition = 0, kVelocity = 3, kHeading = 6, kFix = 7, kMap = 10, kSize = 13 };
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  /// @param covariance_m2  of the position  @param map_std_m  of the map's shift
  void start(const LocalisationNoise& noise, const Eigen::Vector3d& p_W,
             const Eigen::Matrix3d& covariance_m2, const Eigen::Vector3d& map_std_m);

  /// @param v_W  velocity of the inertial unit, m/s  @param dt_s  > 0
  void predict(const Eigen::Vector3d& v_W, double dt_s);

  /// Variance of the innovation of a scalar measurement with gradient h and noise variance r.
  double innovation_variance(const Vector& h, double r) const { return h.dot(P_ * h) + r; }
  /// Applies a scalar measurement. Rejects it if it is not finite or would make a variance
  /// negative. @returns whether it was used
  bool correct(const Vector& h, double innovation, double r);

  const Vector& x() const { return x_; }
  const Matrix& covariance() const { return P_; }
  Eigen::Vector3d p_W() const { return x_.segment<3>(kPosition); }
  Eigen::Vector3d velocity_error_W() const { return x_.segment<3>(kVelocity); }
  double heading_error_rad() const { return x_[kHeading]; }
  Eigen::Vector3d fix_error_W() const { return x_.segment<3>(kFix); }
  /// Sets the slow error of the fixes from now on. From the same source, the estimated error scales
  /// with its standard deviation, as with a receiver's dilution. From another source (`anew`) the
  /// error is unknown and its estimate starts at zero.
  void set_fix_error(const SlowError& horizontal_m, const SlowError& vertical_m, bool anew);
  Eigen::Vector3d map_shift_W() const { return x_.segment<3>(kMap); }
  bool is_sound() const;
  /// Moves the position, for neighbouring hypotheses.
  void shift(const Eigen::Vector3d& by_W) { x_.segment<3>(kPosition) += by_W; }
  /// Adds to the position's covariance.
  void widen(const Eigen::Matrix3d& by_m2) { P_.topLeftCorner<3, 3>() += by_m2; }

 private:
  LocalisationNoise noise_;
  Vector x_ = Vector::Zero();
  Matrix P_ = Matrix::Identity();
};

}  // namespace vinerow::controllers
