#include "controllers/path_follower/slip_estimate.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {
namespace {

constexpr double kKnee_radps = 0.15;  // yaw rate at which a turn begins to contain information
constexpr double kCrawl_mps = 0.3;    // below, angles of the velocity are noise
constexpr double kMinEffectiveness = 0.2, kMaxEffectiveness = 1.25;
constexpr double kLargestArm_m = 0.6;
constexpr double kLargestDrift_rad = 0.3;

/// Share of an input that one step of a first-order low-pass takes over.
double low_pass_share(double dt_s, double time_s) {
  return time_s > 0.0 ? 1.0 - std::exp(-dt_s / time_s) : 1.0;
}

double weight_of(double yaw_rate_radps) {
  const double square = yaw_rate_radps * yaw_rate_radps;
  return square / (square + kKnee_radps * kKnee_radps);
}

}  // namespace

void SlipEstimate::update(double commanded_radps, double measured_radps, const Eigen::Vector2d& v_B,
                          double dt_s) {
  if (params_.learn_time_s <= 0.0) return;
  lagged_radps_ += low_pass_share(dt_s, params_.response_s) * (commanded_radps - lagged_radps_);
  const double share = low_pass_share(dt_s, params_.filter_s);
  commanded_radps_ += share * (lagged_radps_ - commanded_radps_);
  measured_radps_ += share * (measured_radps - measured_radps_);
  v_B_ += share * (v_B - v_B_);

  const double learn = dt_s / params_.learn_time_s;
  constexpr double kNoTurn_radps = 1e-3;
  if (std::abs(commanded_radps_) > kNoTurn_radps) {
    const double measured = std::clamp(measured_radps_ / commanded_radps_, 0.0, 2.0);
    effectiveness_ += learn * weight_of(commanded_radps_) * (measured - effectiveness_);
    effectiveness_ = std::clamp(effectiveness_, kMinEffectiveness, kMaxEffectiveness);
  }
  if (v_B_.x() < kCrawl_mps) return;
  const double turning = weight_of(measured_radps_);
  if (params_.learns_arm && std::abs(measured_radps_) > kNoTurn_radps) {
    const double measured = (v_B_.x() * slide_.drift_rad - v_B_.y()) / measured_radps_;
    slide_.arm_m += learn * turning * (std::clamp(measured, -1.0, 1.0) - slide_.arm_m);
    slide_.arm_m = std::clamp(slide_.arm_m, -kLargestArm_m, kLargestArm_m);
  }
  const double drift = (v_B_.y() + slide_.arm_m * measured_radps_) / v_B_.x();
  slide_.drift_rad += learn * (1.0 - turning) * (drift - slide_.drift_rad);
  slide_.drift_rad = std::clamp(slide_.drift_rad, -kLargestDrift_rad, kLargestDrift_rad);
}

}  // namespace vinerow::controllers
