#include "controllers/estimation/inertial/error_state_kalman.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace vinerow::controllers {
namespace {

/// Limits of plausible readings: more than any unit on a vehicle measures, so a broken message.
/// Chosen.
constexpr double kMaxRate_radps = 200.0;
constexpr double kMaxForce_mps2 = 2000.0;
/// Largest variance (m2, m2/s2, rad2, ...): larger ones mean nothing, and their squares must stay
/// finite. Chosen.
constexpr double kMaxVariance = 1e15;
/// Share of kMaxVariance to which a repair limits a variance, and the variance of an error of which
/// nothing is known. Chosen.
constexpr double kRepairedShare = 0.1;
constexpr double kUnknownVariance = 1.0;
/// Rounding allowed in P_ij^2 <= P_ii P_jj, relative and absolute. Chosen.
constexpr double kMaxCorrelation2 = 1.0 + 1e-6;
constexpr double kMinProduct = 1e-30;

}  // namespace

// Nominal state x = (p, v, q, b_w, b_f), error dx = (dp, dv, dtheta, db_w, db_f) with covariance P.
// Over a step dt with readings w, f, means of this reading and the one before (propagate):
//
//   q <- q Exp((w - b_w) dt),   f_W = (R_old (f_old - b_f) + R_new (f - b_f)) / 2,   a = f_W - g z
//   p <- p + v dt + a dt^2/2,   v <- v + a dt
//   P <- F P F' + Q,   F = ErrorTransition at the mid-step attitude
//
// Q of white acceleration noise n_f (variance density per axis) and of the gyro noise n_w:
//
//   Q_pp = n_f dt^3/3,  Q_pv = n_f dt^2/2,  Q_vv = n_f dt,  Q_theta = n_w dt
//
// and the random walks of the biases times dt. Correction (Sola eq. 274-276), then injection and
// reset (eq. 283-287):
//
//   S = H P H' + R,  NIS = y' S^-1 y,  K = P H'/s per scalar,  x <- x (+) dx,  dx <- 0
//
// Late measurements: every correction at time t_i changes the past too, since the motion between is
// known. With t the time since the start, a correction (dp, dv) at t_i moves the position at t <
// t_i by dp - (t_i - t) dv. Sums of dp - t_i dv, dv and dtheta, kept with each past state, give the
// change since then (past).

PastState interpolate(const PastState& older, const PastState& newer, double share) {
  const auto mix = [share](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return Eigen::Vector3d(a + share * (b - a));
  };
  PastState result;
  result.p_WI = mix(older.p_WI, newer.p_WI);
  result.v_WI = mix(older.v_WI, newer.v_WI);
  result.q_WB = older.q_WB.slerp(share, newer.q_WB);
  result.w_B = mix(older.w_B, newer.w_B);
  result.drift_p = mix(older.drift_p, newer.drift_p);
  result.drift_v = mix(older.drift_v, newer.drift_v);
  result.drift_att = mix(older.drift_att, newer.drift_att);
  return result;
}

void ErrorStateKalman::start(Time now, const NavState& state, const ErrorCovariance& covariance) {
  started_ = true;
  begin_ = time_ = now;
  state_ = state;
  P_ = covariance;
  start_variances_ = covariance.diagonal();
  has_reading_ = is_coasting_ = false;
  R_WB_ = state.q_WB.toRotationMatrix();
  f_W_ = {0.0, 0.0, params_.gravity_mps2};
  drift_p_.setZero();
  drift_v_.setZero();
  drift_att_.setZero();
  trace_.clear();
  remember();
}

bool ErrorStateKalman::predict(Time stamp, const Eigen::Vector3d& w_B, const Eigen::Vector3d& f_B,
                               int samples) {
  const bool absurd = !w_B.allFinite() || !f_B.allFinite() || w_B.norm() > kMaxRate_radps ||
                      f_B.norm() > kMaxForce_mps2;
  // The first reading may have the time of the start: it is kept for the first step.
  const bool is_first = stamp == time_ && !has_reading_;
  if (!started_ || absurd || (stamp <= time_ && !is_first)) {
    ++refused_readings_;
    return false;
  }
  if (!is_first) {
    if ((stamp - time_).s() > params_.longest_step_s) coast(stamp);
    if (stamp > time_) {
      const Eigen::Vector3d w_before_B = has_reading_ ? w_B_ : w_B;
      const Eigen::Vector3d f_before_B = has_reading_ ? f_B_ : f_B;
      propagate(0.5 * (w_before_B + w_B) - state_.gyro_bias_B, f_before_B - state_.accel_bias_B,
                f_B - state_.accel_bias_B, stamp, params_.imu, std::max(1, samples));
    }
  }
  w_B_ = w_B;
  f_B_ = f_B;
  has_reading_ = true;
  is_coasting_ = false;
  remember();
  return true;
}

void ErrorStateKalman::coast(Time now) {
  if (!started_ || now <= time_) return;
  if (!is_coasting_) ++gaps_;
  is_coasting_ = true;
  ImuNoise noise = params_.imu;
  noise.gyro_radps_rtHz = params_.gap_gyro_radps_rtHz;
  noise.accel_mps2_rtHz = params_.gap_accel_mps2_rtHz;
  // Straight motion: no rotation, and a specific force that balances gravity.
  const Eigen::Vector3d f_B =
      state_.q_WB.conjugate() * Eigen::Vector3d(0.0, 0.0, params_.gravity_mps2);
  propagate(Eigen::Vector3d::Zero(), f_B, f_B, now, noise, 1);
  has_reading_ = false;
  w_B_ = state_.gyro_bias_B;
  remember();
}

void ErrorStateKalman::propagate(const Eigen::Vector3d& w_B, const Eigen::Vector3d& f_before_B,
                                 const Eigen::Vector3d& f_B, Time now, const ImuNoise& noise,
                                 int samples) {
  const double dt = (now - time_).s();
  const Eigen::Quaterniond q_before = state_.q_WB;
  state_.q_WB = (q_before * exp_rotation(dt * w_B)).normalized();
  f_W_ = 0.5 * (q_before * f_before_B + state_.q_WB * f_B);
  R_WB_ = (q_before * exp_rotation(0.5 * dt * w_B)).toRotationMatrix();
  const Eigen::Vector3d a_W = f_W_ - Eigen::Vector3d(0.0, 0.0, params_.gravity_mps2);
  state_.p_WI += dt * state_.v_WI + (0.5 * dt * dt) * a_W;
  state_.v_WI += dt * a_W;
  time_ = now;

  ErrorTransition(R_WB_, f_W_, dt).propagate(P_);
  // The white noise of a reading is density / sqrt(period). If one of n readings was used for the
  // whole step, its noise has n times the variance.
  const double accel = samples * noise.accel_mps2_rtHz * noise.accel_mps2_rtHz;
  const double gyro = samples * noise.gyro_radps_rtHz * noise.gyro_radps_rtHz;
  const double gyro_walk = noise.gyro_walk_radps2_rtHz * noise.gyro_walk_radps2_rtHz;
  const double accel_walk = noise.accel_walk_mps3_rtHz * noise.accel_walk_mps3_rtHz;
  for (int axis = 0; axis < 3; ++axis) {
    const int p = ErrorIndex::kPosition + axis, v = ErrorIndex::kVelocity + axis;
    P_(p, p) += accel * dt * dt * dt / 3.0;
    P_(p, v) += 0.5 * accel * dt * dt;
    P_(v, p) += 0.5 * accel * dt * dt;
    P_(v, v) += accel * dt;
    P_(ErrorIndex::kAttitude + axis, ErrorIndex::kAttitude + axis) += gyro * dt;
    P_(ErrorIndex::kGyroBias + axis, ErrorIndex::kGyroBias + axis) += gyro_walk * dt;
    P_(ErrorIndex::kAccelBias + axis, ErrorIndex::kAccelBias + axis) += accel_walk * dt;
  }
  if (!(P_.diagonal().minCoeff() >= 0.0 && P_.diagonal().maxCoeff() < kMaxVariance)) repair();
}

Correction ErrorStateKalman::correct_scalar(double innovation, const ErrorRow& H, double variance,
                                            double gate_sigma) {
  using One = Eigen::Matrix<double, 1, 1>;
  return correct<1>(One(innovation), H, One(variance), gate_sigma);
}

Correction ErrorStateKalman::correct_vector(const Eigen::Vector3d& innovation, const Rows3& H,
                                            const Eigen::Vector3d& variances, double gate_sigma) {
  return correct<3>(innovation, H, variances, gate_sigma);
}

template <int N>
Correction ErrorStateKalman::correct(const Eigen::Matrix<double, N, 1>& innovation,
                                     const Eigen::Matrix<double, N, ErrorIndex::kCount>& H,
                                     const Eigen::Matrix<double, N, 1>& variances,
                                     double gate_sigma) {
  const bool valid = started_ && innovation.allFinite() && H.allFinite() && variances.allFinite() &&
                     variances.minCoeff() >= 0.0;
  if (!valid) return {};
  // Gate the whole vector, then apply it as scalars.
  if (!is_sound()) repair();
  Eigen::Matrix<double, N, N> S = H * P_ * H.transpose();
  if (!(S.diagonal().minCoeff() >= 0.0)) {
    repair();
    S = H * P_ * H.transpose();
  }
  S.diagonal() += variances;
  const Eigen::LLT<Eigen::Matrix<double, N, N>> factor(S);
  if (factor.info() != Eigen::Success) return {};
  const double nis = innovation.dot(factor.solve(innovation));
  if (!std::isfinite(nis)) return {};
  const double gate = gate_sigma + std::sqrt(static_cast<double>(N)) - 1.0;
  if (nis > gate * gate) return {Correction::Verdict::kGated, nis};

  ErrorVector dx = ErrorVector::Zero();
  for (int i = 0; i < N; ++i) {
    const ErrorRow row = H.row(i);
    apply_scalar(innovation[i] - row.dot(dx), row, variances[i], dx);
  }
  if (!inject(dx)) {
    repair();
    return {};
  }
  return {Correction::Verdict::kUsed, nis};
}

/// Sola eq. 274-276 for one component, Joseph form: (1 - K H) P (1 - K H)' + K R K'.
void ErrorStateKalman::apply_scalar(double innovation, const ErrorRow& H, double variance,
                                    ErrorVector& dx) {
  const ErrorVector PH = P_ * H.transpose();
  const double s = H.dot(PH) + variance;
  if (!(s > 0.0)) return;
  const ErrorVector K = PH / s;
  dx += K * innovation;
  P_.noalias() -= K * PH.transpose();
  const ErrorVector rest = P_ * H.transpose() - variance * K;
  P_.noalias() -= rest * K.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

/// Injection, Sola eq. 283, and reset, eq. 285-287, with section 7's G = 1 + [dtheta / 2]x.
bool ErrorStateKalman::inject(const ErrorVector& dx) {
  const NavState corrected = state_.plus(dx);
  if (!corrected.is_finite()) return false;
  state_ = corrected;
  const Eigen::Vector3d turn = dx.segment<3>(ErrorIndex::kAttitude);
  const Eigen::Matrix3d G = Eigen::Matrix3d::Identity() + skew(0.5 * turn);
  P_.middleRows<3>(ErrorIndex::kAttitude) = (G * P_.middleRows<3>(ErrorIndex::kAttitude)).eval();
  P_.middleCols<3>(ErrorIndex::kAttitude) =
      (P_.middleCols<3>(ErrorIndex::kAttitude) * G.transpose()).eval();

  drift_p_ += dx.segment<3>(ErrorIndex::kPosition) -
              (time_ - begin_).s() * dx.segment<3>(ErrorIndex::kVelocity);
  drift_v_ += dx.segment<3>(ErrorIndex::kVelocity);
  drift_att_ += turn;
  return true;
}

/// Cheap necessary conditions: finite, variances not negative, correlations <= 1.
bool ErrorStateKalman::is_sound() const {
  const ErrorVector variances = P_.diagonal();
  if (!(variances.minCoeff() >= 0.0 && variances.maxCoeff() < kMaxVariance)) return false;
  for (int i = 0; i < ErrorIndex::kCount; ++i) {
    for (int j = 0; j < i; ++j) {
      if (!(P_(i, j) * P_(i, j) <= kMaxCorrelation2 * variances[i] * variances[j] + kMinProduct))
        return false;
    }
  }
  return true;
}

/// Keeps the valid variances and drops all correlations, which is positive definite. An invalid
/// variance is replaced by that of the start.
void ErrorStateKalman::repair() {
  ++repairs_;
  const ErrorVector variances = P_.diagonal();
  P_.setZero();
  for (int i = 0; i < ErrorIndex::kCount; ++i) {
    const auto good = [](double variance) { return variance > 0.0 && std::isfinite(variance); };
    const double variance = good(variances[i])          ? variances[i]
                            : good(start_variances_[i]) ? start_variances_[i]
                                                        : kUnknownVariance;
    P_(i, i) = std::min(variance, kRepairedShare * kMaxVariance);
  }
}

void ErrorStateKalman::restart_at(const Eigen::Vector3d& p_WI, const Eigen::Vector3d& p_variances,
                                  const Eigen::Vector3d& v_WI, double v_variance) {
  state_.p_WI = p_WI;
  state_.v_WI = v_WI;
  P_.topRows<6>().setZero();
  P_.leftCols<6>().setZero();
  P_.diagonal().segment<3>(ErrorIndex::kPosition) = p_variances;
  P_.diagonal().segment<3>(ErrorIndex::kVelocity).setConstant(v_variance);
  trace_.clear();
  remember();
}

void ErrorStateKalman::loosen_attitude(double tilt_variance, double yaw_variance) {
  P_.diagonal().segment<3>(ErrorIndex::kAttitude) +=
      Eigen::Vector3d(tilt_variance, tilt_variance, yaw_variance);
}

void ErrorStateKalman::remember() {
  trace_.add(time_, {state_.p_WI, state_.v_WI, state_.q_WB, w_B(), drift_p_, drift_v_, drift_att_});
}

bool ErrorStateKalman::remembers(Time time) const {
  return !trace_.empty() && time >= trace_.oldest();
}

PastState ErrorStateKalman::past(Time time) const {
  PastState past = trace_.at(time);
  // Change of the past since then: dp - t_i dv + t dv, dv, dtheta.
  const double since_start_s = (std::min(time, time_) - begin_).s();
  past.p_WI += drift_p_ - past.drift_p + since_start_s * (drift_v_ - past.drift_v);
  past.v_WI += drift_v_ - past.drift_v;
  past.q_WB = exp_rotation(drift_att_ - past.drift_att) * past.q_WB;
  return past;
}

}  // namespace vinerow::controllers
