#pragma once
/// First-order Gauss-Markov process: exponentially correlated noise with zero mean.

#include <cmath>

#include "engine/core/random.h"

namespace vinerow::sensors {

/// x(k+1) = decay x(k) + kick n, with decay = exp(-period / time): the exact discretisation, so
/// that variance and correlation exp(-t / time) do not depend on the rate.
class GaussMarkov {
 public:
  GaussMarkov() = default;
  /// @param std       stationary, any unit
  /// @param time_s    correlation time; 0: white, a fresh value every step
  /// @param period_s  between steps
  GaussMarkov(double std, double time_s, double period_s)
      : std_(std),
        decay_(time_s > 0.0 ? std::exp(-period_s / time_s) : 0.0),
        kick_(std * std::sqrt(1.0 - decay_ * decay_)) {}

  /// Starts in the stationary distribution. Draws one number.
  void start(RandomStream& random) { value_ = std_ * random.normal(); }
  /// Advances by one step. Draws one number. @returns the new value
  double step(RandomStream& random) { return value_ = decay_ * value_ + kick_ * random.normal(); }
  double value() const { return value_; }

 private:
  double std_ = 0.0;
  double decay_ = 0.0;
  double kick_ = 0.0;
  double value_ = 0.0;
};

}  // namespace vinerow::sensors
