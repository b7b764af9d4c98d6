#include "controllers/autopilot/ardupilot/start_command.h"

#include <fmt/format.h>

#include <utility>

#include "controllers/autopilot/ardupilot/vehicle_parameters.h"
#include "controllers/autopilot/firmware/firmware_autopilot.h"
#include "controllers/autopilot/frames/firmware_frame.h"
#include "controllers/autopilot/mavlink/gps_input.h"

namespace vinerow::controllers {
namespace {

constexpr int kPortsPerInstance = 10;  // ArduPilot's, for each of its ports

}  // namespace

int lockstep_port_of(const FirmwareParams& params) {
  constexpr int kFirst = 9002;
  return kFirst + kPortsPerInstance * params.instance;
}

int mavlink_port_of(const FirmwareParams& params) {
  constexpr int kFirst = 14555;  // beside 14550 and 14551, which ground stations use
  return params.mavlink_port > 0 ? params.mavlink_port
                                 : kFirst + kPortsPerInstance * params.instance;
}

std::vector<std::string> start_command(const FirmwareParams& params,
                                       const AutopilotContext& context) {
  std::vector<std::string> words = params.command;
  if (words.empty()) return words;
  words.front() = find_program(words.front(), "VINEROW_ARDUPILOT");
  if (words.size() == 1) {
    // The speed is a ceiling at which it would sleep; the serial port would wait for a client.
    const std::string start = fmt::format("{}", kFirmwareStart_s);
    for (const char* word : {"--wipe", "--model", "JSON:{address}", "--instance", "{instance}",
                             "--home", "{home}", "--speedup", "1000", "--start-time", start.c_str(),
                             "--serial0", "{mavlink}", "--defaults", "{parameters}"}) {
      words.emplace_back(word);
    }
  }
  const FirmwareFrame frame(context.origin, FirmwareFrame::Receiver::kOfFirmware);
  const std::pair<std::string, std::string> places[] = {
      {"{address}", params.address},
      {"{instance}", fmt::format("{}", params.instance)},
      {"{home}", frame.home_text()},
      {"{mavlink}", fmt::format("udpclient:{}:{}", params.address, mavlink_port_of(params))},
      {"{parameters}", kParameterFile}};
  for (std::string& word : words) {
    for (const auto& [name, value] : places) {
      for (auto at = word.find(name); at != std::string::npos; at = word.find(name, at)) {
        word.replace(at, name.size(), value);
        at += value.size();
      }
    }
  }
  return words;
}

std::vector<FirmwareParameter> start_parameters(const FirmwareParams& params,
                                                const AutopilotContext& context) {
  std::vector<FirmwareParameter> parameters = vehicle_parameters(params, context);
  for (const FirmwareParameter& parameter : user_parameters(params)) {
    set_parameter(parameters, parameter);
  }
  return parameters;
}

}  // namespace vinerow::controllers
