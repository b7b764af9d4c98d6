#include "engine/sensors/encoders.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "engine/api/messages/commands.h"
#include "engine/core/error.h"
#include "engine/sensors/reading_sensor.h"
#include "engine/sensors/resolution.h"

namespace vinerow::sensors {
namespace {

/// Error model of one kind of encoder.
struct Channel {
  double resolution = 0.0;
  double noise_std = 0.0;

  double read(double truth, RandomStream& random) const {
    return round_to_step(truth + noise_std * random.normal(), resolution);
  }
};

/// Defaults: a 12-bit absolute magnetic encoder on the steering axle (AMS AS5600 data sheet: 4096
/// steps per turn, 0.015 deg noise with the slow filter), and a motor's hall-sensor speed estimate
/// (chosen: 0.01 rad/s at the wheel).
struct EncodersParams {
  Channel angle{0.00153398, 0.00026};
  Channel speed{0.005, 0.01};
};

const ParameterTable<EncodersParams>& encoders_table() {
  using P = EncodersParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("angle_resolution_rad", "rad", inside(&P::angle, &Channel::resolution),
                  between(0.0, 1.0), "step of angle readings; 0 = none")
          .number("angle_noise_std_rad", "rad", inside(&P::angle, &Channel::noise_std),
                  between(0.0, 1.0), "white noise of angle readings")
          .number("speed_resolution_radps", "rad/s", inside(&P::speed, &Channel::resolution),
                  between(0.0, 10.0), "step of speed readings; 0 = none")
          .number("speed_noise_std_radps", "rad/s", inside(&P::speed, &Channel::noise_std),
                  between(0.0, 10.0), "white noise of speed readings");
  return table;
}

class Encoders final : public ReadingSensor<NamedValues> {
 public:
  Encoders(const ParameterSet& parameters, const SensorContext& context)
      : ReadingSensor(parameters, context),
        vehicle_(context.vehicle_truth),
        random_(context.random()) {
    const EncodersParams params = encoders_table().read(parameters, context.part);
    const VehicleDescription& about = vehicle_->description();
    if (vehicle_->actuator_states().empty()) {
      throw ConfigError(fmt::format(
          "{}: encoders measure the states of a vehicle's actuators, which vehicle type "
          "'{}' does not have",
          context.part, about.type));
    }
    for (const ActuatorSpec& actuator : about.actuators) {
      if (actuator.unit != "rad" && actuator.unit != "rad/s") {
        throw ConfigError(
            fmt::format("{}: actuator '{}' is in {}; encoders measure rad and rad/s only",
                        context.part, actuator.name, actuator.unit));
      }
      channels_.push_back(actuator.unit == "rad" ? params.angle : params.speed);
      reading_.names.push_back(actuator.name);
    }
    reading_.values.assign(channels_.size(), 0.0);
    exact_ = reading_;
    readings_.prefill(reading_);
  }

  void step(Time now) override {
    const std::span<const double> truth = vehicle_->actuator_states();
    const bool out = readings_.is_in_outage(now);
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      const double value = channels_[i].read(truth[i], random_);
      exact_.values[i] = truth[i];
      reading_.values[i] = out ? std::numeric_limits<double>::infinity() : value;
    }
    readings_.push(now, reading_, exact_);
  }

 private:
  const Vehicle* vehicle_;
  RandomStream random_;
  std::vector<Channel> channels_;  // per actuator
  NamedValues reading_;
  NamedValues exact_;
};

}  // namespace

PartSpec encoders_spec() {
  return reading_sensor_spec<NamedValues>(
      "encoders", "Steering angles and wheel speeds of the actuators, with noise and resolution",
      50.0, encoders_table().specs());
}

std::unique_ptr<Sensor> make_encoders(const ParameterSet& parameters,
                                      const SensorContext& context) {
  return std::make_unique<Encoders>(parameters, context);
}

}  // namespace vinerow::sensors
