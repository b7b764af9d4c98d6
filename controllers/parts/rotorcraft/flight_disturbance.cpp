#include "controllers/parts/rotorcraft/flight_disturbance.h"

#include <Eigen/Geometry>
#include <cmath>

namespace vinerow::controllers {
namespace {

// Largest estimate, half of gravity: far above any wind, and not enough to turn the vehicle over.
// The same number limits angular accelerations, of which the rotors have some 60 rad/s2.
constexpr double kMaxShareOfGravity = 0.5;
constexpr double kMaxAngular_radps2 = 20.0;

Eigen::Vector3d limit_length(const Eigen::Vector3d& v, double max) {
  return v.cwiseMax(-max).cwiseMin(max);
}

}  // namespace

FlightDisturbance::FlightDisturbance(const RotorcraftModel& craft, double time_s,
                                     bool learns_torque, double period_s)
    : craft_(craft),
      gain_(time_s > 0.0 ? 1.0 - std::exp(-period_s / time_s) : 0.0),
      learns_torque_(learns_torque),
      period_s_(period_s) {}

void FlightDisturbance::reset() {
  has_last_ = false;
  acceleration_W_.setZero();
  angular_B_.setZero();
}

void FlightDisturbance::update(const Odometry& odometry, const Wrench& mean, bool learn) {
  const Eigen::Vector3d v_W = odometry.X_WB.q * odometry.v_WB_B;
  const Eigen::Vector3d z_W = odometry.X_WB.q * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d& w_B = odometry.w_WB_B;
  if (has_last_ && learn) {
    const Eigen::Vector3d mean_v = 0.5 * (v_W + v_W_), mean_w = 0.5 * (w_B + w_B_);
    Eigen::Vector3d explained = (mean.thrust_N / craft_.mass_kg) * (z_W + z_W_).normalized() -
                                (craft_.rotor_drag_Ns_per_m / craft_.mass_kg) * mean_v;
    explained.z() -= craft_.gravity_mps2;
    acceleration_W_ += gain_ * ((v_W - v_W_) / period_s_ - explained - acceleration_W_);
    acceleration_W_ = limit_length(acceleration_W_, kMaxShareOfGravity * craft_.gravity_mps2);
    if (learns_torque_) {
      const Eigen::Vector3d& J = craft_.inertia_kgm2;
      const Eigen::Vector3d explained_w =
          (mean.torque_B - mean_w.cross(J.cwiseProduct(mean_w))).cwiseQuotient(J);
      angular_B_ += gain_ * ((w_B - w_B_) / period_s_ - explained_w - angular_B_);
      angular_B_ = limit_length(angular_B_, kMaxAngular_radps2);
    }
  }
  v_W_ = v_W;
  z_W_ = z_W;
  w_B_ = w_B;
  has_last_ = true;
}

}  // namespace vinerow::controllers
