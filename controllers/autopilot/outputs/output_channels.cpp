#include "controllers/autopilot/outputs/output_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow::controllers {
namespace {

/// Share of the pulse's range.
double share_of(double pwm_us, const OutputChannel& channel, bool has_one_direction) {
  if (has_one_direction) {
    return std::clamp((pwm_us - channel.min_us) / (channel.max_us - channel.min_us), 0.0, 1.0);
  }
  const double side = pwm_us > channel.trim_us ? channel.max_us - channel.trim_us
                                               : channel.trim_us - channel.min_us;
  return std::clamp((pwm_us - channel.trim_us) / side, -1.0, 1.0);
}

/// A reversed function of one direction is full where it was off.
double reverse_if(const OutputChannel& channel, bool has_one_direction, double share) {
  if (!channel.is_reversed) return share;
  return has_one_direction ? 1.0 - share : -share;
}

bool front_right_turns_counter_clockwise(const VehicleDescription& vehicle) {
  const std::vector<RotorPlace>& rotors = vehicle.rotorcraft->rotors;
  // The drag of a rotor that turns counter-clockwise turns the body to the right.
  return std::any_of(rotors.begin(), rotors.end(), [](const RotorPlace& rotor) {
    return rotor.p_B.x() > 0.0 && rotor.p_B.y() < 0.0 && rotor.torque_sign < 0.0;
  });
}

}  // namespace

const ParameterTable<OutputChannel>& output_channel_table() {
  using P = OutputChannel;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("function", &P::function,
                "what the output drives: left, right, throttle, steering, front_steering, "
                "rear_steering, motor_front_left, motor_front_right, motor_rear_left, "
                "motor_rear_right, elevon_left, elevon_right")
          .required()
          .integer("output", &P::output, between(1, 32), "number of the output; 1 is the first")
          .required()
          .boolean("reversed", &P::is_reversed, "the output works the other way round")
          .number("min_us", "us", &P::min_us, between(500.0, 2500.0), "shortest pulse")
          .number("trim_us", "us", &P::trim_us, between(500.0, 2500.0),
                  "neutral pulse of a function of two directions")
          .number("max_us", "us", &P::max_us, between(500.0, 2500.0), "longest pulse")
          .rule([](const P& channel) {
            const bool is_ordered =
                channel.min_us < channel.trim_us && channel.trim_us < channel.max_us;
            return is_ordered
                       ? std::string()
                       : fmt::format(
                             "min_us = {:g}, trim_us = {:g} and max_us = {:g} of "
                             "'{}' must be in this order",
                             channel.min_us, channel.trim_us, channel.max_us, channel.function);
          });
  return table;
}

std::vector<OutputChannel> default_output_channels(const VehicleDescription& vehicle,
                                                   const OutputMixer& mixer) {
  const auto output_of = [&](const std::string& function) {
    if (function == "left" || function == "steering" || function == "front_steering" ||
        function == "elevon_left") {
      return 1;
    }
    if (function == "rear_steering" || function == "elevon_right") return 2;
    if (function == "right" || function == "throttle") return 3;
    const bool is_x = front_right_turns_counter_clockwise(vehicle);
    if (function == "motor_front_right") return is_x ? 1 : 2;
    if (function == "motor_rear_left") return is_x ? 2 : 3;
    if (function == "motor_front_left") return is_x ? 3 : 4;
    return is_x ? 4 : 1;  // motor_rear_right
  };
  std::vector<OutputChannel> channels;
  for (const OutputFunction& function : mixer.functions()) {
    OutputChannel channel;
    channel.function = function.name;
    channel.output = output_of(function.name);
    channels.push_back(std::move(channel));
  }
  return channels;
}

OutputMap::OutputMap(const VehicleDescription& vehicle, const std::string& mixer,
                     std::vector<OutputChannel> channels, int outputs, const std::string& who)
    : mixer_(make_output_mixer(vehicle, mixer, who)) {
  if (channels.empty()) channels = default_output_channels(vehicle, *mixer_);
  std::vector<std::string> names;
  for (const OutputFunction& function : mixer_->functions()) names.push_back(function.name);

  for (std::size_t i = 0; i < channels.size(); ++i) {
    const OutputChannel& channel = channels[i];
    if (std::find(names.begin(), names.end(), channel.function) == names.end()) {
      throw ConfigError(fmt::format(
          "{}: channels[{}]: vehicle type '{}' has no function '{}'{} (known: {})", who, i,
          vehicle.type, channel.function, did_you_mean(channel.function, names), join(names)));
    }
    if (channel.output > outputs) {
      throw ConfigError(fmt::format("{}: channels[{}]: the autopilot has no output {}, only {}",
                                    who, i, channel.output, outputs));
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (channels[k].function == channel.function) {
        throw ConfigError(fmt::format("{}: channels: '{}' occurs twice", who, channel.function));
      }
      if (channels[k].output == channel.output) {
        throw ConfigError(fmt::format("{}: channels: output {} drives both '{}' and '{}'", who,
                                      channel.output, channels[k].function, channel.function));
      }
    }
  }
  for (const std::string& name : names) {
    const auto at = std::find_if(channels.begin(), channels.end(),
                                 [&](const auto& channel) { return channel.function == name; });
    if (at == channels.end()) {
      throw ConfigError(fmt::format("{}: channels: no output drives '{}'; needed are {}", who, name,
                                    join(names)));
    }
    channels_.push_back(*at);
  }
  values_.resize(channels_.size());
}

void OutputMap::apply_pulses(std::span<const std::uint16_t> pwm_us, NamedValues& actuators) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const bool one_direction = mixer_->functions()[i].has_one_direction;
    const auto output = static_cast<std::size_t>(channels_[i].output - 1);
    const double pulse = output < pwm_us.size() ? pwm_us[output] : 0.0;
    const double share = share_of(pulse, channels_[i], one_direction);
    values_[i] = pulse > 0.0 ? reverse_if(channels_[i], one_direction, share) : 0.0;
  }
  mixer_->mix(values_, actuators);
}

void OutputMap::apply_shares(std::span<const float> values, NamedValues& actuators) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const bool one_direction = mixer_->functions()[i].has_one_direction;
    const auto output = static_cast<std::size_t>(channels_[i].output - 1);
    const double given = output < values.size() ? values[output] : 0.0F;
    const double share = std::clamp(given, one_direction ? 0.0 : -1.0, 1.0);
    values_[i] = std::isfinite(given) ? reverse_if(channels_[i], one_direction, share) : 0.0;
  }
  mixer_->mix(values_, actuators);
}

void OutputMap::apply_neutral(NamedValues& actuators) {
  std::fill(values_.begin(), values_.end(), 0.0);
  mixer_->mix(values_, actuators);
}

}  // namespace vinerow::controllers
