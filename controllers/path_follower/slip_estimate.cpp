#include "controllers/path_follower/slip_estimate.h"

#include <algorithm>
#include <cmath>

namespace vinerow {

void SlipEstimate::update(double asked_radps, double measured_radps, double dt_s) {
  if (params_.learn_time_s <= 0.0) return;
  const auto low_pass = [dt_s](double& state, double input, double time_s) {
    state += (input - state) * (time_s > 0.0 ? 1.0 - std::exp(-dt_s / time_s) : 1.0);
  };
  low_pass(lagged_radps_, asked_radps, params_.response_s);
  low_pass(asked_radps_, lagged_radps_, params_.filter_s);
  low_pass(measured_radps_, measured_radps, params_.filter_s);
  // Slow turning tells little and is full of noise: its weight goes to zero with its square.
  constexpr double kKnee_radps = 0.15;
  const double square = asked_radps_ * asked_radps_;
  const double weight = square / (square + kKnee_radps * kKnee_radps);
  if (square < 1e-6) return;
  const double seen = measured_radps_ / asked_radps_;
  effectiveness_ += dt_s / params_.learn_time_s * weight * (seen - effectiveness_);
  effectiveness_ = std::clamp(effectiveness_, params_.min, params_.max);
}

}  // namespace vinerow
