#pragma once
/// Files with parameters of autopilots: Mission Planner's and ArduPilot's `.parm` ("NAME VALUE" or
/// "NAME,VALUE"), and QGroundControl's `.params` (vehicle, component, name, value, type).

#include <filesystem>
#include <string>
#include <vector>

namespace vinerow::controllers {

struct FirmwareParameter {
  std::string name;  ///< at most 16 characters
  double value = 0.0;
};

/// A later line replaces an earlier one. @param file  for errors  @throws ConfigError
/// "rover.parm:7: ..."
std::vector<FirmwareParameter> parse_parameters(const std::string& text,
                                                const std::filesystem::path& file);
/// As parse_parameters(). @throws ConfigError also if the file cannot be read
std::vector<FirmwareParameter> read_parameter_file(const std::filesystem::path& file);

/// Sets a parameter: replaces it, or adds it at the end.
void set_parameter(std::vector<FirmwareParameter>& parameters, const FirmwareParameter& wanted);

/// As ArduPilot's option --defaults reads them.
std::string parameter_text(const std::vector<FirmwareParameter>& parameters);

}  // namespace vinerow::controllers
