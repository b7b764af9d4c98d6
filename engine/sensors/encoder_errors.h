#pragma once
/// Errors of encoders on steering axles and wheels.

#include "engine/api/parameter_table.h"
#include "engine/core/random.h"

namespace vinerow::sensors {

/// Error model of one kind of encoder.
struct EncoderChannel {
  double resolution = 0.0;
  double noise_std = 0.0;

  double read(double truth, RandomStream& random) const;
  /// Standard deviation of a reading: noise, and a step's uniform rounding error.
  double std() const;
};

/// Defaults: a 12-bit absolute magnetic encoder on the steering axle (AMS AS5600 data sheet: 4096
/// steps per turn, 0.015 deg noise with the slow filter), and a motor's hall-sensor speed estimate
/// (chosen: 0.01 rad/s at the wheel).
struct EncoderErrors {
  EncoderChannel angle{0.00153398, 0.00026};
  EncoderChannel speed{0.005, 0.01};
};

const ParameterTable<EncoderErrors>& encoder_errors_table();

}  // namespace vinerow::sensors
