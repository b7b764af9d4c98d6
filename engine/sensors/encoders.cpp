#include "engine/sensors/encoders.h"

#include <fmt/format.h>

#include <limits>

#include "engine/api/messages/commands.h"
#include "engine/core/error.h"
#include "engine/sensors/encoder_errors.h"
#include "engine/sensors/reading_sensor.h"

namespace vinerow::sensors {
namespace {

class Encoders final : public ReadingSensor<NamedValues> {
 public:
  Encoders(const ParameterSet& parameters, const SensorContext& context)
      : ReadingSensor(parameters, context),
        vehicle_(context.vehicle_truth),
        random_(context.random()) {
    const EncoderErrors errors = encoder_errors_table().read(parameters, context.part);
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
      channels_.push_back(actuator.unit == "rad" ? errors.angle : errors.speed);
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
  std::vector<EncoderChannel> channels_;  // per actuator
  NamedValues reading_;
  NamedValues exact_;
};

}  // namespace

PartSpec encoders_spec() {
  return reading_sensor_spec<NamedValues>(
      "encoders", "Steering angles and wheel speeds of the actuators, with noise and resolution",
      50.0, encoder_errors_table());
}

std::unique_ptr<Sensor> make_encoders(const ParameterSet& parameters,
                                      const SensorContext& context) {
  return std::make_unique<Encoders>(parameters, context);
}

}  // namespace vinerow::sensors
