#include "controllers/autopilot/ardupilot/vehicle_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/autopilot/firmware/sensor_mounting.h"
#include "controllers/autopilot/outputs/output_mixer.h"
#include "engine/api/vehicle.h"
#include "engine/api/vehicle_kinds.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

using Parameters = std::vector<FirmwareParameter>;

/// Marks that say "calibrated" to its checks before arming: accelerometers with small offsets. Its
/// compasses are calibrated from the start.
void add_calibrations(Parameters& parameters) {
  for (const char* sensor : {"", "2"}) {
    for (const char* axis : {"X", "Y", "Z"}) {
      parameters.push_back({fmt::format("INS_ACC{}OFFS_{}", sensor, axis), 0.001});
      parameters.push_back({fmt::format("INS_ACC{}SCAL_{}", sensor, axis), 1.001});
    }
  }
  // Its gyroscopes would drift by themselves: they have the errors of our sensor, or none.
  parameters.push_back({"SIM_DRIFT_SPEED", 0});
}

/// Number of an output's function, SERVOn_FUNCTION.
int function_number(const std::string& function, const std::vector<OutputChannel>& usual) {
  constexpr std::pair<const char*, int> kNumbers[] = {
      {"steering", 26}, {"front_steering", 26}, {"rear_steering", 26}, {"throttle", 70},
      {"left", 73},     {"right", 74},          {"elevon_left", 77},   {"elevon_right", 78}};
  for (const auto& [name, number] : kNumbers) {
    if (function == name) return number;
  }
  // Motors are counted in the order of the frame, which their usual outputs follow.
  constexpr int kMotor1 = 33;
  const auto motor = std::find_if(usual.begin(), usual.end(), [&](const OutputChannel& channel) {
    return channel.function == function;
  });
  return kMotor1 + motor->output - 1;
}

void add_outputs(const FirmwareParams& params, const VehicleDescription& vehicle,
                 const std::string& who, Parameters& parameters) {
  const auto mixer = make_output_mixer(vehicle, params.mixer, who);
  const std::vector<OutputChannel> usual = default_output_channels(vehicle, *mixer);
  for (const OutputChannel& channel : params.channels.empty() ? usual : params.channels) {
    const auto add = [&](const char* name, double value) {
      parameters.push_back({fmt::format("SERVO{}_{}", channel.output, name), value});
    };
    add("FUNCTION", function_number(channel.function, usual));
    add("MIN", channel.min_us);
    add("MAX", channel.max_us);
    // Both axles get the same steering; the rear one turns the other way.
    const bool turns_back = channel.function == "rear_steering";
    add("REVERSED", channel.is_reversed != turns_back ? 1 : 0);
    if (!vehicle.flies()) add("TRIM", channel.trim_us);
  }
}

void add_rover(const VehicleDescription& vehicle, Parameters& parameters) {
  const double top_mps = vehicle.max_speed_mps.value_or(2.0);
  // A share of the throttle is that share of the top speed: our drives follow their set speed. The
  // rest is for turning: the outer wheels are faster.
  constexpr double kShare = 0.75;
  const double cruise_mps = kShare * top_mps;
  parameters.push_back({"CRUISE_SPEED", cruise_mps});
  parameters.push_back({"CRUISE_THROTTLE", 100.0 * kShare});
  parameters.push_back({"WP_SPEED", cruise_mps});
  // Steering per rad/s. The whole steering of axles turns the vehicle by v / R, and ArduPilot
  // divides it by v (MOT_SPD_SCA_BASE is 1 m/s), so this is the smallest radius R. Skid-steered
  // rovers keep ArduPilot's 0.2.
  const double radius_m = vehicle.min_turning_radius_m.value_or(0.0);
  if (vehicle.steers_by_axles() && radius_m > 0.0) {
    parameters.push_back({"TURN_RADIUS", radius_m});
    parameters.push_back({"ATC_STR_RAT_FF", radius_m});
  }
}

void add_copter(const VehicleDescription& vehicle, const AutopilotContext& context,
                const std::vector<OutputChannel>& usual, Parameters& parameters) {
  const Rotorcraft& rotors = *vehicle.rotorcraft;
  const auto first = std::find_if(usual.begin(), usual.end(),
                                  [](const OutputChannel& channel) { return channel.output == 1; });
  constexpr int kX = 1, kReversedX = 18;
  parameters.push_back({"FRAME_CLASS", 1});
  parameters.push_back(
      {"FRAME_TYPE",
       static_cast<double>(first->function == "motor_front_right" ? kX : kReversedX)});
  // Thrust is the square of the output, and there is no battery whose voltage drops.
  parameters.push_back({"MOT_THST_EXPO", 1});
  parameters.push_back({"MOT_BAT_VOLT_MAX", 0});
  parameters.push_back({"MOT_SPIN_MAX", 1});
  const double top_N = static_cast<double>(rotors.rotors.size()) * rotors.thrust_coefficient_Ns2 *
                       rotors.max_rotor_radps * rotors.max_rotor_radps;
  constexpr double kGravity_mps2 = 9.80665;
  parameters.push_back(
      {"MOT_THST_HOVER", std::clamp(vehicle.mass_kg * kGravity_mps2 / top_N, 0.1, 0.8)});
  // It arms only if its sensors come 1.8 times as often as it controls.
  constexpr double kSamplesPerLoop = 1.8, kUsualLoop_Hz = 400.0;
  const double rate_Hz = 1.0 / context.period.s();
  const double loop_Hz = std::floor(rate_Hz / kSamplesPerLoop);
  if (loop_Hz < kUsualLoop_Hz) parameters.push_back({"SCHED_LOOP_RATE", loop_Hz});
}

void add_plane(const VehicleDescription& vehicle, Parameters& parameters) {
  const FixedWingAircraft& plane = *vehicle.fixed_wing;
  parameters.push_back({"AIRSPEED_CRUISE", plane.cruise_speed_mps});
  parameters.push_back({"AIRSPEED_MIN", 1.15 * plane.stall_speed_mps});
  parameters.push_back(
      {"AIRSPEED_MAX", vehicle.max_speed_mps.value_or(1.5 * plane.cruise_speed_mps)});
  parameters.push_back({"ROLL_LIMIT_DEG", std::floor(deg_from_rad(plane.max_bank_rad))});
}

/// Rangefinders, airspeed, battery and receiver that we simulate.
void add_sensors(const FirmwareParams& params, const AutopilotContext& context,
                 Parameters& parameters) {
  constexpr int kSimulated = 100, kByMavlink = 14, kVoltageAndCurrent = 4;
  for (std::size_t i = 0; i < params.ranges.size(); ++i) {
    const std::string prefix = fmt::format("RNGFND{}_", i + 1);
    parameters.push_back({prefix + "TYPE", kSimulated});
    const auto orientation = range_orientation(params.ranges[i], context.sensors);
    if (orientation) parameters.push_back({prefix + "ORIENT", static_cast<double>(*orientation)});
  }
  if (!params.airspeed.empty()) {
    parameters.push_back({"ARSPD_TYPE", kSimulated});
    parameters.push_back({"ARSPD_USE", 1});
    parameters.push_back({"ARSPD_SKIP_CAL", 1});
  }
  if (params.battery_V > 0.0) parameters.push_back({"BATT_MONITOR", kVoltageAndCurrent});
  if (!params.gnss.empty()) parameters.push_back({"GPS1_TYPE", kByMavlink});
}

}  // namespace

Parameters vehicle_parameters(const FirmwareParams& params, const AutopilotContext& context) {
  const VehicleDescription& vehicle = *context.vehicle_description;
  Parameters parameters;
  // The log is written by a thread whose pace would show.
  parameters.push_back({"LOG_BACKEND_TYPE", 0});
  add_calibrations(parameters);
  add_outputs(params, vehicle, context.part, parameters);
  if (vehicle.rotorcraft) {
    const auto mixer = make_output_mixer(vehicle, params.mixer, context.part);
    add_copter(vehicle, context, default_output_channels(vehicle, *mixer), parameters);
  } else if (vehicle.fixed_wing) {
    add_plane(vehicle, parameters);
  } else {
    add_rover(vehicle, parameters);
  }
  add_sensors(params, context, parameters);
  return parameters;
}

}  // namespace vinerow::controllers
