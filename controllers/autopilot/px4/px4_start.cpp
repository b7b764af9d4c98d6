#include "controllers/autopilot/px4/px4_start.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "controllers/autopilot/firmware/firmware_autopilot.h"
#include "controllers/autopilot/px4/px4_parameters.h"

namespace vinerow::controllers {

int px4_port_of(const FirmwareParams& params) {
  constexpr int kFirst = 4560;
  return kFirst + params.instance;
}

int px4_mavlink_port_of(const FirmwareParams& params) {
  constexpr int kFirst = 14540;  // of its link to a companion computer
  return params.mavlink_port > 0 ? params.mavlink_port : kFirst + params.instance;
}

std::vector<std::string> px4_command(const FirmwareParams& params) {
  std::vector<std::string> words = params.command;
  if (words.empty()) return words;
  words.front() = find_program(words.front(), "VINEROW_PX4");
  const std::string instance = fmt::format("{}", params.instance);
  if (words.size() == 1) {
    const std::filesystem::path program(words.front());
    const auto files = std::filesystem::absolute(program).parent_path().parent_path() / "etc";
    words.insert(words.end(), {"-i", instance, "-d", "-s", "etc/init.d-posix/rcS", files.string()});
    return words;
  }
  for (std::string& word : words) {
    constexpr std::string_view kPlace = "{instance}";
    for (auto at = word.find(kPlace); at != std::string::npos; at = word.find(kPlace, at)) {
      word.replace(at, kPlace.size(), instance);
    }
  }
  return words;
}

std::vector<std::string> px4_environment(const FirmwareParams& params,
                                         const AutopilotContext& context) {
  const char* path = std::getenv("PATH");
  return {fmt::format("PATH={}:{}", std::filesystem::absolute(context.folder).string(),
                      path != nullptr ? path : "/usr/bin:/bin"),
          fmt::format("PX4_SYS_AUTOSTART={}", px4_airframe(*context.vehicle_description)),
          "PX4_SIM_HOST_ADDR=" + params.address};
}

std::string px4_parameter_script(const FirmwareParams& params, const AutopilotContext& context) {
  std::vector<FirmwareParameter> parameters = px4_parameters(params, context);
  for (const FirmwareParameter& parameter : user_parameters(params)) {
    set_parameter(parameters, parameter);
  }
  std::string script;
  for (const auto& [name, value] : parameters) {
    script += fmt::format("param set {} {:.9g}\n", name, value);
  }
  return script;
}

}  // namespace vinerow::controllers
