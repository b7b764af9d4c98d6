#include "controllers/parts/rotorcraft/rotor_mixer.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/math/decomposition.h"

namespace vinerow::controllers {

RotorMixer::RotorMixer(const RotorcraftModel& craft, const std::string& who) : craft_(craft) {
  const int rotors = static_cast<int>(craft.rotors.size());
  wrench_of_thrusts_.resize(4, rotors);
  const double drag_arm_m = craft.torque_coefficient_Nms2 / craft.thrust_coefficient_Ns2;
  for (int i = 0; i < rotors; ++i) {
    const RotorPlace& rotor = craft.rotors[i];
    wrench_of_thrusts_.col(i) << 1.0, rotor.p_B.y(), -rotor.p_B.x(), rotor.torque_sign * drag_arm_m;
  }
  // Each row has its own size (yaw is far weaker than roll); only directions matter for the rank.
  const Eigen::Vector4d row_size = wrench_of_thrusts_.rowwise().norm().cwiseMax(1e-12);
  const Eigen::MatrixXd rows = row_size.cwiseInverse().asDiagonal() * wrench_of_thrusts_;
  const Eigen::Matrix4d gram = rows * rows.transpose();
  const Eigen::Vector4d eigenvalues = decompose_symmetric<4>(gram).values;
  constexpr double kMinShare = 1e-12;
  if (rotors < 4 || eigenvalues(0) < kMinShare * eigenvalues(3)) {
    throw ConfigError(fmt::format(
        "{}: {} rotors with these places and torque signs cannot make thrust and the torques about "
        "all three axes independently",
        who, rotors));
  }
  thrusts_of_wrench_ = rows.transpose() * gram.inverse() * row_size.cwiseInverse().asDiagonal();
  for (int i = 0; i < rotors; ++i) {
    if (thrusts_of_wrench_(i, 0) <= 0.0) {
      throw ConfigError(
          fmt::format("{}: rotor {} would have to pull down when the vehicle hovers; the rotors "
                      "must be placed around the centre of mass",
                      who, i + 1));
    }
  }
  min_N_ = craft.thrust_coefficient_Ns2 * craft.min_rotor_radps * craft.min_rotor_radps;
  max_N_ = craft.thrust_coefficient_Ns2 * craft.max_rotor_radps * craft.max_rotor_radps;
  thrusts_N_ = Eigen::VectorXd::Zero(rotors);
  roll_pitch_N_ = Eigen::VectorXd::Zero(rotors);
}

// Some T fits all rotors, least <= s r_i + T t_i <= most, if the lower bound on T of any rotor i is
// below the upper bound of any rotor j: s (r_j / t_j - r_i / t_i) <= room.
double RotorMixer::largest_roll_pitch_share() const {
  double share = 1.0;
  for (int i = 0; i < roll_pitch_N_.size(); ++i) {
    for (int j = 0; j < roll_pitch_N_.size(); ++j) {
      const double t_i = thrusts_of_wrench_(i, 0), t_j = thrusts_of_wrench_(j, 0);
      const double spread = roll_pitch_N_(j) / t_j - roll_pitch_N_(i) / t_i;
      const double max_spread = max_N_ / t_j - min_N_ / t_i;
      if (spread > 0.0 && share * spread > max_spread) share = std::max(max_spread, 0.0) / spread;
    }
  }
  return share;
}

double RotorMixer::nearest_thrust_N(double wanted_N) const {
  double lower_N = -std::numeric_limits<double>::infinity(), upper_N = -lower_N;
  for (int i = 0; i < roll_pitch_N_.size(); ++i) {
    const double t = thrusts_of_wrench_(i, 0);
    lower_N = std::max(lower_N, (min_N_ - roll_pitch_N_(i)) / t);
    upper_N = std::min(upper_N, (max_N_ - roll_pitch_N_(i)) / t);
  }
  return std::max(lower_N, std::min(upper_N, wanted_N));
}

double RotorMixer::largest_yaw_share(double torque_Nm) const {
  double share = 1.0;
  for (int i = 0; i < thrusts_N_.size(); ++i) {
    const double extra_N = thrusts_of_wrench_(i, 3) * torque_Nm;
    const double margin_N = extra_N > 0.0 ? max_N_ - thrusts_N_(i) : min_N_ - thrusts_N_(i);
    if (share * std::abs(extra_N) > std::abs(margin_N)) share = std::abs(margin_N / extra_N);
  }
  return share;
}

Wrench RotorMixer::mix(const Wrench& wanted, std::vector<double>& speeds_radps) {
  VINEROW_ASSERT(speeds_radps.size() == craft_.rotors.size());
  roll_pitch_N_ = thrusts_of_wrench_.col(1) * wanted.torque_B.x() +
                  thrusts_of_wrench_.col(2) * wanted.torque_B.y();
  roll_pitch_N_ *= largest_roll_pitch_share();
  thrusts_N_ = roll_pitch_N_ + thrusts_of_wrench_.col(0) * nearest_thrust_N(wanted.thrust_N);
  // Rounding must not leave a rotor slightly outside, from where "room" would have the wrong sign.
  thrusts_N_ = thrusts_N_.cwiseMax(min_N_).cwiseMin(max_N_);
  const double yaw_Nm = wanted.torque_B.z();
  thrusts_N_ += thrusts_of_wrench_.col(3) * (largest_yaw_share(yaw_Nm) * yaw_Nm);
  thrusts_N_ = thrusts_N_.cwiseMax(min_N_).cwiseMin(max_N_);
  for (std::size_t i = 0; i < speeds_radps.size(); ++i) {
    // The square root of the limit's square may exceed the limit by rounding.
    const double speed = std::sqrt(thrusts_N_(static_cast<int>(i)) / craft_.thrust_coefficient_Ns2);
    speeds_radps[i] = std::clamp(speed, craft_.min_rotor_radps, craft_.max_rotor_radps);
  }
  return wrench_of(speeds_radps);
}

Wrench RotorMixer::wrench_of(const std::vector<double>& speeds_radps) const {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (std::size_t i = 0; i < speeds_radps.size(); ++i) {
    sum += wrench_of_thrusts_.col(static_cast<int>(i)) *
           (craft_.thrust_coefficient_Ns2 * speeds_radps[i] * speeds_radps[i]);
  }
  return {sum(0), sum.tail<3>()};
}

Eigen::Vector3d RotorMixer::torque_limits_at_hover() const {
  const double weight_N = craft_.mass_kg * craft_.gravity_mps2;
  Eigen::Vector3d limits = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  for (int i = 0; i < thrusts_of_wrench_.rows(); ++i) {
    const double hover_N = thrusts_of_wrench_(i, 0) * weight_N;
    const double margin_N = std::max(std::min(max_N_ - hover_N, hover_N - min_N_), 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const double share = std::abs(thrusts_of_wrench_(i, 1 + axis));
      if (share > 0.0) limits(axis) = std::min(limits(axis), margin_N / share);
    }
  }
  return limits;
}

}  // namespace vinerow::controllers
