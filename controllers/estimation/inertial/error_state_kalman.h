#pragma once
/// Error-state Kalman filter of an inertial unit: strapdown prediction, full covariance,
/// corrections by any measurement with a known gradient. Independent of signals.
///
/// Source: J. Sola, "Quaternion kinematics for the error-state Kalman filter", 2017
/// (arXiv:1711.02508), section 5.3 (kinematics), 6 (correction, injection, reset: eq. 283-287) and
/// 7 (attitude error in W). A correction applies scalars one after another in Joseph form.
///
/// Late measurements are compared with past(), a ring of past states that every later correction
/// moves; their gradient is at_age(). Both treat the motion since then as free of noise.

#include <cstdint>

#include "controllers/estimation/inertial/error_state.h"
#include "controllers/estimation/parts/trace.h"
#include "engine/core/time.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

/// White noise and bias random walks of an inertial unit. The defaults are from the VectorNav
/// VN-100/VN-200 data sheet: gyro 0.0035 deg/s/rtHz and 10 deg/h in-run, accelerometer 0.14 mg/rtHz
/// and 0.04 mg in-run. The walks reach the in-run figure within 100 s.
struct ImuNoise {
  double gyro_radps_rtHz = rad_from_deg(0.0035);
  double accel_mps2_rtHz = 0.00137;
  double gyro_walk_radps2_rtHz = rad_from_deg(2.8e-4);
  double accel_walk_mps3_rtHz = 3.9e-5;
};

struct ErrorStateKalmanParams {
  ImuNoise imu;
  double gap_gyro_radps_rtHz = 0.5;  ///< noise of the motion while the IMU is silent
  double gap_accel_mps2_rtHz = 3.0;
  double longest_step_s = 0.1;  ///< a longer time between two readings is a gap
  double gravity_mps2 = 9.80665;
};

/// Result of a correction.
struct Correction {
  enum class Verdict {
    kUsed,
    kGated,   ///< its NIS is beyond the gate
    kInvalid  ///< not finite, or no filter yet
  };
  Verdict verdict = Verdict::kInvalid;
  double nis = 0.0;  ///< normalised innovation squared, y' S^-1 y

  bool used() const { return verdict == Verdict::kUsed; }
};

/// A past state, with all later corrections applied.
struct PastState {
  Eigen::Vector3d p_WI = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WI = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d w_B = Eigen::Vector3d::Zero();  ///< rate without bias
  /// Sums over all corrections up to that time: dp - t dv, dv, dtheta.
  Eigen::Vector3d drift_p = Eigen::Vector3d::Zero();
  Eigen::Vector3d drift_v = Eigen::Vector3d::Zero();
  Eigen::Vector3d drift_att = Eigen::Vector3d::Zero();
};
PastState interpolate(const PastState& older, const PastState& newer, double share);

class ErrorStateKalman {
 public:
  using Rows3 = Eigen::Matrix<double, 3, ErrorIndex::kCount>;

  explicit ErrorStateKalman(const ErrorStateKalmanParams& params) : params_(params) {}

  bool started() const { return started_; }
  /// Starts or restarts. A covariance that is not positive definite is repaired at the first use.
  void start(Time now, const NavState& state, const ErrorCovariance& covariance);

  /// Propagates state and covariance to a reading of the IMU; second order in the step (mean of
  /// this reading and the one before). For a gap it assumes straight motion.
  /// @param w_B,f_B  rate and specific force at I along B's axes
  /// @param samples  readings since the previous call; only the last of them is given @returns
  /// false if the reading was refused: not finite or absurd, not newer than the state
  bool predict(Time stamp, const Eigen::Vector3d& w_B, const Eigen::Vector3d& f_B, int samples = 1);
  /// Propagates without a reading: straight motion, with the noise of a gap.
  void coast(Time now);

  /// One measurement z = h(x) + noise. @param innovation  z - h(nominal)
  /// @param H  gradient of h with respect to the errors (ErrorIndex)
  /// @param variance  of the noise, >= 0  @param gate_sigma  larger innovations are refused
  Correction correct_scalar(double innovation, const ErrorRow& H, double variance,
                            double gate_sigma);
  /// Three numbers at once with independent noise and one common gate: NIS <= (gate_sigma + sqrt(3)
  /// - 1)^2, which has nearly the tail probability of gate_sigma for one number.
  Correction correct_vector(const Eigen::Vector3d& innovation, const Rows3& H,
                            const Eigen::Vector3d& variances, double gate_sigma);

  /// Discards position and velocity and restarts them at the given values.
  void restart_at(const Eigen::Vector3d& p_WI, const Eigen::Vector3d& p_variances,
                  const Eigen::Vector3d& v_WI, double v_variance);
  /// Adds to the attitude's variances, rad2.
  void loosen_attitude(double tilt_variance, double yaw_variance);

  /// @returns false if the time is older than the states that are kept
  bool remembers(Time time) const;
  /// State at a past time, with all later corrections applied. The newest state for later times.
  /// @pre started()
  PastState past(Time time) const;
  /// Gradient with respect to the current errors of a measurement with gradient H with respect to
  /// the errors age_s ago: H F(-age).
  template <class Rows>
  Rows at_age(const Rows& H, double age_s) const {
    return age_s > 0.0 ? Rows(H * ErrorTransition(R_WB_, f_W_, -age_s).matrix()) : H;
  }

  Time time() const { return time_; }
  const NavState& state() const { return state_; }
  const ErrorCovariance& covariance() const { return P_; }
  /// Last rate of the gyro without bias, rad/s.
  Eigen::Vector3d w_B() const { return w_B_ - state_.gyro_bias_B; }

  std::int64_t refused_readings() const { return refused_readings_; }
  /// Number of times that readings were missing for longer than a step.
  std::int64_t gaps() const { return gaps_; }
  /// Number of times that the covariance had lost its positive definiteness.
  std::int64_t repairs() const { return repairs_; }

 private:
  template <int N>
  Correction correct(const Eigen::Matrix<double, N, 1>& innovation,
                     const Eigen::Matrix<double, N, ErrorIndex::kCount>& H,
                     const Eigen::Matrix<double, N, 1>& variances, double gate_sigma);
  void propagate(const Eigen::Vector3d& w_B, const Eigen::Vector3d& f_before_B,
                 const Eigen::Vector3d& f_B, Time now, const ImuNoise& noise, int samples);
  void apply_scalar(double innovation, const ErrorRow& H, double variance, ErrorVector& dx);
  bool inject(const ErrorVector& dx);
  bool is_sound() const;
  void repair();
  void remember();

  ErrorStateKalmanParams params_;
  bool started_ = false;
  Time begin_, time_;
  NavState state_;
  ErrorCovariance P_ = ErrorCovariance::Zero();
  ErrorVector start_variances_ = ErrorVector::Zero();
  bool has_reading_ = false;  ///< one from which the next step may start
  bool is_coasting_ = false;
  Eigen::Vector3d w_B_ = Eigen::Vector3d::Zero(), f_B_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WB_ = Eigen::Matrix3d::Identity();  ///< of the last step, with f_W
  Eigen::Vector3d f_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d drift_p_ = Eigen::Vector3d::Zero(), drift_v_ = Eigen::Vector3d::Zero(),
                  drift_att_ = Eigen::Vector3d::Zero();
  RecentTrace<PastState> trace_;
  std::int64_t refused_readings_ = 0, gaps_ = 0, repairs_ = 0;
};

}  // namespace vinerow::controllers
