#include "controllers/autopilot/firmware/firmware_params.h"

#include <fmt/format.h>

#include "controllers/autopilot/outputs/output_mixer.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

std::vector<std::string> mixer_choices() {
  std::vector<std::string> names = output_mixer_names();
  names.insert(names.begin(), "");
  return names;
}

const ParameterTable<StickMove>& stick_table() {
  using P = StickMove;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("at_s", "s", &P::at_s, between(0.0, 1e7), "time since the autopilot's start")
          .required()
          .integer("channel", &P::channel, between(1, 12), "channel of the receiver")
          .required()
          .integer("pulse_us", &P::pulse_us, between(800, 2200), "position, us; 1500: middle")
          .required();
  return table;
}

const ParameterTable<ParameterRow>& parameter_row_table() {
  using P = ParameterRow;
  constexpr double kFloatMax = 3.4e38;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("name", &P::name, "name in the firmware, at most 16 characters")
          .required()
          .number("value", "", &P::value, between(-kFloatMax, kFloatMax), "value")
          .required();
  return table;
}

const ParameterTable<CommandRow>& command_table() {
  using P = CommandRow;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("at_s", "s", &P::at_s, between(0.0, 1e7), "time since the autopilot's start")
          .required()
          .integer("command", &P::command, between(1, 65535), "number of a MAV_CMD")
          .required()
          .numbers("params", "", &P::params, between(-1e9, 1e9),
                   "param1 to param7; those that are left out are 0")
          .rule([](const P& row) {
            return row.params.size() <= 7
                       ? std::string()
                       : fmt::format("params has {} numbers; a command has 7", row.params.size());
          });
  return table;
}

/// What decides which state an autopilot gets, and what its outputs do.
ParameterTable<FirmwareParams> exchange_table() {
  using P = FirmwareParams;
  return ParameterTable<P>()
      .text("mixer", &P::mixer,
            "functions of the vehicle that the outputs drive; default: by the vehicle's kind")
      .one_of(mixer_choices())
      .groups("channels", &P::channels, output_channel_table(),
              "which output drives which function; default: docs/guides/autopilots.md")
      .text("imu", &P::imu, "sensor whose readings the autopilot gets; default: without errors")
      .texts("ranges", &P::ranges,
             "sensors for its rangefinders; where nothing is seen it gets a metre more than the "
             "sensor's range")
      .text("airspeed", &P::airspeed, "sensor for its air speed; default: none")
      .groups("sticks", &P::sticks, stick_table(), "what the pilot does, in order of time")
      .text("gnss", &P::gnss,
            "receiver whose readings replace those that the firmware makes up; default: its own")
      .boolean(
          "mavlink", &P::uses_mavlink,
          "listen to the firmware: its estimate, its words, missions; without it the vehicle's "
          "estimate is the truth")
      .path("mission", &P::mission,
            "mission that it gets (.plan, .waypoints, or lines of a map); default: the plan of the "
            "vehicle's planner, if there is one")
      .number("plan_tolerance_m", "m", &P::plan_tolerance_m, kPositive,
              "farthest that the legs between waypoints may be from that plan")
      .number("ready_timeout_s", "s", &P::ready_timeout_s, above(0.0, 1e6),
              "simulated time until its own checks let it be armed for the mission")
      .groups("commands", &P::commands, command_table(),
              "commands of MAVLink that it gets, in order of time")
      .number("finish_at_s", "s", &P::finish_at_s, between(0.0, 1e7),
              "time since its start at which the task is done; 0: never");
}

void add_battery(ParameterTable<FirmwareParams>& table) {
  table.number("battery_V", "V", &FirmwareParams::battery_V, between(0.0, 1000.0),
               "voltage of its battery, whose current follows from the vehicle's power; 0: none");
}

void add_magnetometer_and_barometer(ParameterTable<FirmwareParams>& table) {
  table
      .text("magnetometer", &FirmwareParams::magnetometer,
            "sensor whose readings PX4 gets as its compass")
      .text("barometer", &FirmwareParams::barometer,
            "sensor whose readings PX4 gets as its barometer");
}

/// Names and numbers that differ between the firmwares.
struct StartWords {
  const char *instance, *command, *mavlink_port;
};

/// How the firmware is started and reached.
void add_start(ParameterTable<FirmwareParams>& table, const StartWords& words) {
  using P = FirmwareParams;
  table.text("address", &P::address, "own address; the autopilot sends its outputs there")
      .integer("instance", &P::instance, between(0, 250), words.instance)
      .texts("command", &P::command, words.command)
      .number("start_timeout_s", "s", &P::start_timeout_s, above(0.0, 1e6),
              "wall time until its first outputs")
      .number("answer_timeout_s", "s", &P::answer_timeout_s, above(0.0, 1e6),
              "wall time until its outputs for a state")
      .integer("mavlink_port", &P::mavlink_port, between(0, 65535), words.mavlink_port)
      .path("parameter_file", &P::parameter_file,
            "parameters of the firmware (.parm, .params); a program that is started gets them "
            "with its start, and every one by MAVLink")
      .groups("parameters", &P::parameters, parameter_row_table(),
              "parameters of the firmware, which replace those of the file")
      .text("record", &P::record,
            "name of a pcap file for all datagrams, in the run's folder; default: none");
}

}  // namespace

const ParameterTable<FirmwareParams>& ardupilot_table() {
  static const ParameterTable<FirmwareParams> table = [] {
    ParameterTable<FirmwareParams> rows = exchange_table();
    add_battery(rows);
    add_start(rows,
              {"number of the autopilot on this machine: the UDP port is 9002 + 10 * instance",
               "program and arguments to start; a program without / is searched for in the "
               "folder VINEROW_ARDUPILOT and in PATH. Default: it runs already, or is started by "
               "hand",
               "own UDP port for MAVLink; 0: 14555 + 10 * instance"});
    return rows;
  }();
  return table;
}

const ParameterTable<FirmwareParams>& px4_table() {
  static const ParameterTable<FirmwareParams> table = [] {
    ParameterTable<FirmwareParams> rows = exchange_table();
    rows.reword("imu", "sensor whose readings the autopilot gets");
    rows.reword("gnss", "receiver whose readings the autopilot gets");
    rows.reword("channels",
                "which output drives which function; default: docs/guides/autopilots.md. Pulses "
                "play no part: outputs are shares");
    add_magnetometer_and_barometer(rows);
    add_start(rows,
              {"number of the autopilot on this machine: the TCP port is 4560 + instance",
               "program and arguments to start; a program without / is searched for in the "
               "folder VINEROW_PX4 (PX4's build folder), in its bin, and in PATH. Default: it runs "
               "already, or is started by hand",
               "own UDP port for MAVLink; 0: 14540 + instance"});
    return rows;
  }();
  return table;
}

const ParameterTable<AutopilotReplayParams>& autopilot_replay_table() {
  using P = AutopilotReplayParams;
  static const ParameterTable<P> table = [] {
    ParameterTable<FirmwareParams> exchange = exchange_table();
    add_battery(exchange);
    add_magnetometer_and_barometer(exchange);
    ParameterTable<P> rows;
    rows.path("file", &P::file, "recording of an autopilot (parameter `record`)")
        .required()
        .include(&P::of, exchange);
    return rows;
  }();
  return table;
}

}  // namespace vinerow::controllers
