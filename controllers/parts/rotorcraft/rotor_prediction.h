#pragma once
/// Predicted rotor speeds after a command: w' = (wanted - w) / lag. Rotor speeds are not measured;
/// an error of the prediction decays with the lag.

#include <vector>

#include "controllers/parts/rotorcraft/rotor_mixer.h"

namespace vinerow::controllers {

class RotorPrediction {
 public:
  RotorPrediction(const RotorcraftModel& craft, const RotorMixer& mixer);

  /// Rotors at rest.
  void reset();
  /// Rotors at these speeds, rad/s.
  void set_speeds(const std::vector<double>& speeds_radps) { speeds_radps_ = speeds_radps; }
  /// These speeds are wanted for the next period_s. @param wanted_radps  as many as rotors
  void command(const std::vector<double>& wanted_radps, double period_s);

  /// At the end of the last command.
  Wrench now() const { return mixer_.wrench_of(speeds_radps_); }
  /// Mean over the last command, with the reaction torque of the rotors' spin-up.
  Wrench mean() const {
    Wrench wrench = mixer_.wrench_of(mean_radps_);
    wrench.torque_B.z() += spin_up_Nm_;
    return wrench;
  }

 private:
  const RotorMixer& mixer_;
  double lag_s_;
  std::vector<double> inertia_kgm2_;  ///< of each rotor, signed as its drag torque
  double spin_up_Nm_ = 0.0;
  std::vector<double> speeds_radps_;
  std::vector<double> mean_radps_;  ///< root mean square
};

}  // namespace vinerow::controllers
