#include "controllers/estimation/row_localisation/localisation_state.h"

#include <cmath>

namespace vinerow::controllers {
namespace {

/// Factor by which a slow error decays over dt.
double decay(const SlowError& error, double dt_s) {
  return std::exp(-dt_s / error.time_s);
}
/// Variance that is added over dt, so that the variance of the error stays constant.
double kick(const SlowError& error, double kept) {
  return error.std * error.std * (1.0 - kept * kept);
}

}  // namespace

void LocalisationState::start(const LocalisationNoise& noise, const Eigen::Vector3d& p_W,
                              const Eigen::Matrix3d& covariance_m2,
                              const Eigen::Vector3d& map_std_m) {
  noise_ = noise;
  x_.setZero();
  x_.segment<3>(kPosition) = p_W;
  P_.setZero();
  P_.topLeftCorner<3, 3>() = covariance_m2;
  const auto variance = [](double std) { return std * std; };
  for (int i = 0; i < 3; ++i) {
    P_(kVelocity + i, kVelocity + i) = variance(noise.velocity_mps.std);
    P_(kMap + i, kMap + i) = variance(map_std_m[i]);
  }
  P_(kHeading, kHeading) = variance(noise.heading_rad.std);
  P_(kFix, kFix) = P_(kFix + 1, kFix + 1) = variance(noise.fix_horizontal_m.std);
  P_(kFix + 2, kFix + 2) = variance(noise.fix_vertical_m.std);
}

void LocalisationState::predict(const Eigen::Vector3d& v_W, double dt_s) {
  x_.segment<3>(kPosition) += dt_s * (v_W - x_.segment<3>(kVelocity));
  // F is the identity except for p <- p - dt b: rows, then columns.
  P_.middleRows<3>(kPosition) -= dt_s * P_.middleRows<3>(kVelocity);
  P_.middleCols<3>(kPosition) -= dt_s * P_.middleCols<3>(kVelocity);
  Vector kept = Vector::Ones(), added = Vector::Zero();
  const auto slow = [&](int i, const SlowError& error) {
    kept[i] = decay(error, dt_s);
    added[i] = kick(error, kept[i]);
  };
  for (int i = 0; i < 3; ++i) slow(kVelocity + i, noise_.velocity_mps);
  slow(kHeading, noise_.heading_rad);
  slow(kFix, noise_.fix_horizontal_m), slow(kFix + 1, noise_.fix_horizontal_m);
  slow(kFix + 2, noise_.fix_vertical_m);
  const double walk_m2 = noise_.velocity_density_m_rts * noise_.velocity_density_m_rts * dt_s;
  added.segment<3>(kPosition).setConstant(walk_m2);
  x_.array() *= kept.array();
  P_.array().colwise() *= kept.array();
  P_.array().rowwise() *= kept.array().transpose();
  P_.diagonal() += added;
}

bool LocalisationState::correct(const Vector& h, double innovation, double r) {
  const Vector Ph = P_ * h;
  const double s = h.dot(Ph) + r;
  if (!std::isfinite(innovation) || !(s > 0.0) || !(r > 0.0)) return false;
  x_ += Ph * (innovation / s);
  P_ -= (Ph / s) * Ph.transpose();
  // Removes rounding only: in exact arithmetic the update is symmetric, and with r > 0 P stays
  // positive.
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  return true;
}

void LocalisationState::set_fix_error(const SlowError& horizontal_m, const SlowError& vertical_m,
                                      bool anew) {
  const auto set = [&](int i, const SlowError& before, const SlowError& now) {
    if (anew || !(before.std > 0.0)) {
      x_[i] = 0.0;
      P_.row(i).setZero();
      P_.col(i).setZero();
      P_(i, i) = now.std * now.std;
      return;
    }
    const double scale = now.std / before.std;
    x_[i] *= scale;
    P_.row(i) *= scale;
    P_.col(i) *= scale;
  };
  set(kFix, noise_.fix_horizontal_m, horizontal_m);
  set(kFix + 1, noise_.fix_horizontal_m, horizontal_m);
  set(kFix + 2, noise_.fix_vertical_m, vertical_m);
  noise_.fix_horizontal_m = horizontal_m;
  noise_.fix_vertical_m = vertical_m;
}

bool LocalisationState::is_sound() const {
  return x_.allFinite() && P_.allFinite() && P_.diagonal().minCoeff() >= 0.0 &&
         P_.topLeftCorner<3, 3>().diagonal().minCoeff() > 0.0;
}

}  // namespace vinerow::controllers
