#include "controllers/autopilot/px4/px4_outputs.h"

#include <algorithm>
#include <iterator>

#include "engine/core/check.h"

namespace vinerow::controllers {
namespace {

constexpr int kMotor1 = 101, kServo1 = 201;

struct Px4Function {
  const char* name;
  int output;  ///< usual one
  int number;
};

/// Motors of a rover with two sides are the left and the right one (PX4's rover_differential); both
/// axles follow one steering servo; an aircraft's elevons are servos.
constexpr Px4Function kFunctions[] = {{"motor_front_right", 1, kMotor1},
                                      {"motor_rear_left", 2, kMotor1 + 1},
                                      {"motor_front_left", 3, kMotor1 + 2},
                                      {"motor_rear_right", 4, kMotor1 + 3},
                                      {"left", 1, kMotor1},
                                      {"right", 2, kMotor1 + 1},
                                      {"steering", 1, kServo1},
                                      {"front_steering", 1, kServo1},
                                      {"rear_steering", 2, kServo1},
                                      {"throttle", 3, kMotor1},
                                      {"elevon_left", 1, kServo1},
                                      {"elevon_right", 2, kServo1 + 1}};

const Px4Function& px4_function(const std::string& name) {
  const auto at = std::find_if(std::begin(kFunctions), std::end(kFunctions),
                               [&](const Px4Function& other) { return name == other.name; });
  VINEROW_DEMAND(at != std::end(kFunctions));
  return *at;
}

}  // namespace

std::vector<OutputChannel> px4_output_channels(const FirmwareParams& params,
                                               const VehicleDescription& vehicle,
                                               const std::string& who) {
  if (!params.channels.empty()) return params.channels;
  std::vector<OutputChannel> channels;
  const auto mixer = make_output_mixer(vehicle, params.mixer, who);
  for (const OutputFunction& function : mixer->functions()) {
    OutputChannel channel;
    channel.function = function.name;
    channel.output = px4_function(function.name).output;
    channels.push_back(std::move(channel));
  }
  return channels;
}

int px4_function_number(const std::string& function) {
  return px4_function(function).number;
}

}  // namespace vinerow::controllers
