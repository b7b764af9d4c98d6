#include "alley_centring.h"

#include <vinerow/api/messages.h>
#include <vinerow/api/parameter_table.h>

#include <algorithm>
#include <cmath>

namespace {

struct AlleyCentringParams {
  double speed_mps = 0.8;
  double gain_radps_per_m = 0.8;
  double damping_rad_per_m = 1.5;
};

/// States each parameter once: spec, default, checks and reader come from here.
const vinerow::ParameterTable<AlleyCentringParams>& alley_centring_table() {
  using P = AlleyCentringParams;
  static const auto table =
      vinerow::ParameterTable<P>()
          .number("speed_mps", "m/s", &P::speed_mps, vinerow::kPositive, "forward speed")
          .number("gain_radps_per_m", "rad/s/m", &P::gain_radps_per_m, vinerow::kPositive,
                  "turn per offset")
          .number("damping_rad_per_m", "rad/m", &P::damping_rad_per_m, vinerow::kPositive,
                  "turn per speed of the offset");
  return table;
}

class AlleyCentring final : public vinerow::Controller {
 public:
  AlleyCentring(const AlleyCentringParams& params, const vinerow::ControllerContext& context)
      : params_(params), period_s_(context.period.s()) {
    const vinerow::VehicleDescription& vehicle = *context.vehicle_description;
    const vinerow::WheeledVehicle& wheeled = vehicle.need_wheeled(context.part);
    wheel_radius_m_ = wheeled.wheel_radius_m;
    track_m_ = wheeled.track_m;
    for (const vinerow::ActuatorSpec& actuator : vehicle.actuators)
      command_.names.push_back(actuator.name);
    command_.values.assign(command_.names.size(), 0.0);
  }

  void connect(vinerow::Ports& ports) override {
    left_ = ports.read<vinerow::RangeSample>("sonar_left");
    right_ = ports.read<vinerow::RangeSample>("sonar_right");
    actuators_ = ports.write<vinerow::NamedValues>("actuators");
  }

  void step(vinerow::Time now) override {
    double yaw_rate_radps = 0.0;
    if (left_.has_value() && right_.has_value() && std::isfinite(left_.value().range_m) &&
        std::isfinite(right_.value().range_m)) {
      // Foliage is ragged: a slow mean of the offset, and a still slower view of its rate.
      const double seen_m = 0.5 * (right_.value().range_m - left_.value().range_m);
      const double before_m = offset_m_;
      offset_m_ += 0.1 * (seen_m - offset_m_);
      const double rate_mps = (offset_m_ - before_m) / period_s_;
      yaw_rate_radps = std::clamp(
          -params_.gain_radps_per_m * offset_m_ - params_.damping_rad_per_m * rate_mps, -0.5, 0.5);
    }
    for (std::size_t i = 0; i < command_.names.size(); ++i) {
      const bool left_wheel =
          command_.names[i].find("wheel_fl") == 0 || command_.names[i].find("wheel_rl") == 0;
      const double side = left_wheel ? -0.5 : 0.5;
      command_.values[i] = (params_.speed_mps + side * track_m_ * yaw_rate_radps) / wheel_radius_m_;
    }
    actuators_.write(now, command_);
  }

 private:
  AlleyCentringParams params_;
  double period_s_;
  double wheel_radius_m_ = 0.0;
  double track_m_ = 0.0;
  double offset_m_ = 0.0;
  vinerow::NamedValues command_;
  vinerow::SignalReader<vinerow::RangeSample> left_, right_;
  vinerow::SignalWriter<vinerow::NamedValues> actuators_;
};

}  // namespace

vinerow::PartSpec alley_centring_spec() {
  vinerow::PartSpec spec;
  spec.name = "alley_centring";
  spec.description = "Keeps the middle of an alley by two ultrasonic rangers";
  spec.default_rate_Hz = 20.0;
  alley_centring_table().add_to(spec);
  spec.reads = {"sonar_left", "sonar_right"};
  spec.writes = {"actuators"};
  return spec;
}

std::unique_ptr<vinerow::Controller> make_alley_centring(
    const vinerow::ParameterSet& parameters, const vinerow::ControllerContext& context) {
  return std::make_unique<AlleyCentring>(alley_centring_table().read(parameters, context.part),
                                         context);
}
