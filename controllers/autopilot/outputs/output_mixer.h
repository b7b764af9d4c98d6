#pragma once
/// From the outputs of an autopilot to the actuators of a vehicle.
///
/// An autopilot drives functions: "left" and "right" of a rover that steers by speed difference,
/// "motor_front_left" of a quadrotor. A mixer gives each vehicle its functions and turns their
/// values into actuator commands. Values are shares of the actuators' limits: -1 to 1, or 0 to 1
/// for what has one direction.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/vehicle.h"

namespace vinerow::controllers {

struct OutputFunction {
  std::string name;
  bool has_one_direction = false;  ///< 0 to 1: motors, throttle of an aircraft
};

class OutputMixer {
 public:
  virtual ~OutputMixer() = default;
  virtual const std::vector<OutputFunction>& functions() const = 0;
  /// Actuators with their names, all zero.
  virtual NamedValues make_actuators() const = 0;
  /// @param values  one for each function  @param actuators  of make_actuators(); no heap
  virtual void mix(std::span<const double> values, NamedValues& actuators) const = 0;
};

/// Names of the mixers that a scenario can choose: "skid", "throttle_steering", "ackermann",
/// "four_wheel_steering", "quadrotor_x", "elevons".
std::vector<std::string> output_mixer_names();

/// @param name  of a mixer; "": that of the vehicle's kind ("skid" for a rover without steered
///              wheels)
/// @param who   "rover.autopilot (ardupilot)", for errors
/// @throws ConfigError if the vehicle does not fit the mixer
std::unique_ptr<OutputMixer> make_output_mixer(const VehicleDescription& vehicle,
                                               const std::string& name, const std::string& who);

}  // namespace vinerow::controllers
