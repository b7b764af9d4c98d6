#include "controllers/parts/rotorcraft/rotor_prediction.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {

RotorPrediction::RotorPrediction(const RotorcraftModel& craft, const RotorMixer& mixer)
    : mixer_(mixer),
      lag_s_(craft.rotor_lag_s),
      speeds_radps_(craft.rotors.size(), 0.0),
      mean_radps_(craft.rotors.size(), 0.0) {
  for (const RotorPlace& rotor : craft.rotors) {
    inertia_kgm2_.push_back(rotor.torque_sign * craft.rotor_inertia_kgm2);
  }
}

void RotorPrediction::reset() {
  std::fill(speeds_radps_.begin(), speeds_radps_.end(), 0.0);
  std::fill(mean_radps_.begin(), mean_radps_.end(), 0.0);
  spin_up_Nm_ = 0.0;
}

// w(t) = c + e exp(-t / lag), and the mean of w^2 over the period T is
//   c^2 + 2 c e (lag / T) (1 - exp(-T / lag)) + e^2 (lag / 2 T) (1 - exp(-2 T / lag)).
void RotorPrediction::command(const std::vector<double>& wanted_radps, double period_s) {
  const double left = std::exp(-period_s / lag_s_), ratio = lag_s_ / period_s;
  spin_up_Nm_ = 0.0;
  for (std::size_t i = 0; i < speeds_radps_.size(); ++i) {
    const double c = wanted_radps[i], e = speeds_radps_[i] - c;
    const double square =
        c * c + 2.0 * c * e * ratio * (1.0 - left) + 0.5 * e * e * ratio * (1.0 - left * left);
    mean_radps_[i] = std::sqrt(std::max(square, 0.0));
    speeds_radps_[i] = c + e * left;
    spin_up_Nm_ += inertia_kgm2_[i] * e * (left - 1.0) / period_s;
  }
}

}  // namespace vinerow::controllers
