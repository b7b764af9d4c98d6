#include "engine/sensors/encoder_errors.h"

#include <cmath>

#include "engine/sensors/resolution.h"

namespace vinerow::sensors {

double EncoderChannel::read(double truth, RandomStream& random) const {
  return round_to_step(truth + noise_std * random.normal(), resolution);
}

double EncoderChannel::std() const {
  return std::sqrt(noise_std * noise_std + resolution * resolution / 12.0);
}

const ParameterTable<EncoderErrors>& encoder_errors_table() {
  using P = EncoderErrors;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("angle_resolution_rad", "rad", inside(&P::angle, &EncoderChannel::resolution),
                  between(0.0, 1.0), "step of angle readings; 0 = none")
          .number("angle_noise_std_rad", "rad", inside(&P::angle, &EncoderChannel::noise_std),
                  between(0.0, 1.0), "white noise of angle readings")
          .number("speed_resolution_radps", "rad/s", inside(&P::speed, &EncoderChannel::resolution),
                  between(0.0, 10.0), "step of speed readings; 0 = none")
          .number("speed_noise_std_radps", "rad/s", inside(&P::speed, &EncoderChannel::noise_std),
                  between(0.0, 10.0), "white noise of speed readings");
  return table;
}

}  // namespace vinerow::sensors
