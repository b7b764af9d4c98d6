#pragma once
/// Which output of an autopilot drives which function of a vehicle, and with which pulses.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "controllers/autopilot/outputs/output_mixer.h"
#include "engine/api/parameter_table_fwd.h"

namespace vinerow::controllers {

/// Row of the scenario's list `channels`.
struct OutputChannel {
  std::string function;  ///< as OutputMixer::functions() names it
  int output = 0;        ///< 1 is the first
  bool is_reversed = false;
  double min_us = 1000.0;
  double trim_us = 1500.0;  ///< neutral, for functions of two directions
  double max_us = 2000.0;
};

const ParameterTable<OutputChannel>& output_channel_table();

/// Channels as ArduPilot and PX4 have them by default: skid rovers left on output 1, right on 3;
/// steering on 1 (rear axle 2), throttle on 3; elevons on 1 and 2; motors in the order of an X
/// whose rotor front right turns counter-clockwise, or of ArduPilot's reversed X (FRAME_TYPE 18).
std::vector<OutputChannel> default_output_channels(const VehicleDescription& vehicle,
                                                   const OutputMixer& mixer);

/// Turns outputs into actuators.
class OutputMap {
 public:
  /// @param channels  empty: default_output_channels()
  /// @param outputs   number of outputs that the autopilot has
  /// @throws ConfigError if a function has no channel or two, if an output is used twice or does
  ///   not exist, if a function is unknown, if the pulses are not in order
  OutputMap(const VehicleDescription& vehicle, const std::string& mixer,
            std::vector<OutputChannel> channels, int outputs, const std::string& who);

  NamedValues make_actuators() const { return mixer_->make_actuators(); }
  /// @param pwm_us  widths of the pulses; 0: no signal, which is neutral or off. No heap.
  void apply_pulses(std::span<const std::uint16_t> pwm_us, NamedValues& actuators);
  /// @param values  -1 to 1, or 0 to 1 for functions of one direction; not finite: neutral or off
  void apply_shares(std::span<const float> values, NamedValues& actuators);
  /// Nothing moves: every function is neutral or off, also reversed ones.
  void apply_neutral(NamedValues& actuators);

 private:
  std::unique_ptr<OutputMixer> mixer_;
  std::vector<OutputChannel> channels_;  ///< in the order of the mixer's functions
  std::vector<double> values_;
};

}  // namespace vinerow::controllers
