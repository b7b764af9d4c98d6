#pragma once
/// Linear Kalman filter on a vehicle's position: paper C (Donati et al., Remote Sensing 14(6) 1374,
/// 2022), eq. 16-22, with the velocity of an inertial unit as its input.
///
/// State: position p in W and the correction c of the velocity input, v = v_input + c, a
/// first-order Gauss-Markov process of standard deviation sigma_v and correlation time tau:
///
///     p+ = p + (v_input + c) dt,  c+ = exp(-dt/tau) c,  Q = q dt on p, sigma_v^2 (1 -
///     exp(-2dt/tau)) on c
///
/// Data are applied one after another as they arrive, as scalars or vectors. Late data are
/// measurements of p - c age - (displacement since). Updates have Joseph form. An update that would
/// make the state not finite or the covariance not positive definite is rejected and changes
/// nothing. No heap.

#include <Eigen/Core>

#include "engine/core/time.h"

namespace vinerow::controllers {

struct PositionKalmanParams {
  double velocity_std_mps = 0.05;  ///< sigma_v, each axis; 0: the input has no slow error
  double velocity_time_s = 5.0;    ///< tau, > 0
  double walk_m2_per_s = 1e-6;     ///< q, each axis
  double longest_step_s = 1.0;     ///< a longer time between predictions is shortened to this
};

enum class DatumStatus {
  kAccepted,
  kGated,        ///< the innovation exceeds the gate
  kBadNumber,    ///< not finite, or a variance that is not positive
  kNotPositive,  ///< the covariance would have lost its positive definiteness
  kBackwards,    ///< older than the last prediction
};

class PositionKalman {
 public:
  static constexpr int kSize = 6;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  explicit PositionKalman(const PositionKalmanParams& params) : params_(params) {}

  bool has_started() const { return has_started_; }
  /// @returns false if a number is not finite or the covariance not positive definite
  bool start(Time now, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance_m2);

  /// @param v_W  velocity input over the time since the last prediction, m/s
  DatumStatus predict(Time now, const Eigen::Vector3d& v_W);

  struct Scalar {
    Vector gradient = Vector::Zero();  ///< H
    double innovation = 0.0;           ///< measured minus predicted
    double variance = 1.0;             ///< R
    double gate_sigma = 0.0;           ///< 0: none
    double huber_sigma = 0.0;          ///< beyond it R grows with the innovation; 0: never
  };
  DatumStatus correct(const Scalar& datum);

  /// All three coordinates of a position, one after another. @param age_s  of the data, >= 0
  /// @param innovation  measured minus predicted, at the time of the data
  /// @param gate_sigma  of the whole vector: either all coordinates are used or none
  DatumStatus correct_position(const Eigen::Vector3d& innovation, const Eigen::Vector3d& variance,
                               double age_s, double gate_sigma);

  /// Two horizontal coordinates with a full covariance.
  DatumStatus correct_horizontal(const Eigen::Vector2d& p, const Eigen::Matrix2d& R);

  /// Replaces mean and covariance of the horizontal position. The distribution of the other states
  /// given that position stays the same (Jeffrey's rule).
  DatumStatus replace_horizontal(const Eigen::Vector2d& p, const Eigen::Matrix2d& covariance_m2);

  /// Adds to the position's variance, for a filter that is lost. @param variance_m2  >= 0
  void widen(const Eigen::Vector3d& variance_m2);

  Time time() const { return time_; }
  Eigen::Vector3d p_W() const { return x_.head<3>(); }
  Eigen::Vector3d velocity_correction_W() const { return x_.tail<3>(); }
  Eigen::Matrix3d position_covariance() const { return P_.topLeftCorner<3, 3>(); }
  const Vector& x() const { return x_; }
  const Matrix& covariance() const { return P_; }
  /// innovation^2 / (H P H' + R) of the last scalar, or the mean over the coordinates of the last
  /// vector.
  double last_nis() const { return last_nis_; }

  /// H of a linear function of the position `age_s` ago.
  static Vector gradient_of(const Eigen::Vector3d& dh_dp, double age_s);

 private:
  bool is_sound(const Vector& x, const Matrix& P) const;
  DatumStatus accept(const Vector& x, const Matrix& P);

  PositionKalmanParams params_;
  bool has_started_ = false;
  Time time_;
  Vector x_ = Vector::Zero();
  Matrix P_ = Matrix::Identity();
  double last_nis_ = 0.0;
};

}  // namespace vinerow::controllers
