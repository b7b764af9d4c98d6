#pragma once
/// Parameters of the autopilots `ardupilot`, `px4` and `replay`.

#include <string>
#include <vector>

#include "controllers/autopilot/outputs/output_channels.h"
#include "engine/api/parameter_table_fwd.h"

namespace vinerow::controllers {

/// A position of a pilot's stick or switch, held from a time on.
struct StickMove {
  double at_s = 0.0;
  int channel = 1;
  int pulse_us = 1500;
};

/// A parameter of the firmware, as the scenario gives it.
struct ParameterRow {
  std::string name;
  double value = 0.0;
};

/// A command of MAVLink, sent at a time.
struct CommandRow {
  double at_s = 0.0;
  int command = 0;
  std::vector<double> params;
};

struct FirmwareParams {
  std::string address = "127.0.0.1";
  int instance = 0;
  std::vector<std::string> command;
  double start_timeout_s = 60.0;
  double answer_timeout_s = 10.0;
  std::string mixer;
  std::vector<OutputChannel> channels;
  std::string imu;
  std::string magnetometer;  ///< of PX4
  std::string barometer;     ///< of PX4
  std::vector<std::string> ranges;
  std::string airspeed;
  double battery_V = 0.0;
  std::vector<StickMove> sticks;
  std::string gnss;
  bool uses_mavlink = true;
  std::string mission;
  double plan_tolerance_m = 0.05;
  double ready_timeout_s = 120.0;
  std::vector<CommandRow> commands;
  int mavlink_port = 0;
  std::string parameter_file;
  std::vector<ParameterRow> parameters;
  std::string record;
  double finish_at_s = 0.0;
};

const ParameterTable<FirmwareParams>& ardupilot_table();
const ParameterTable<FirmwareParams>& px4_table();

/// Parameters of the autopilot `replay`: those that shape the exchange, and the recording.
struct AutopilotReplayParams {
  FirmwareParams of;
  std::string file;
};

const ParameterTable<AutopilotReplayParams>& autopilot_replay_table();

}  // namespace vinerow::controllers
