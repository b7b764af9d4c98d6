#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "engine/core/error.h"
#include "engine/io/files/placed_error.h"
#include "engine/math/angles.h"
#include "engine/scenario/shipped_file.h"
#include "tools/pictures/trim_report.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

/// Name of the vehicle in the scenario that includes it, and so in errors.
constexpr const char* kName = "plane";

struct TrimArguments {
  std::filesystem::path file;
  std::vector<std::string> sets;
  std::vector<std::filesystem::path> plugins;
  double speed_mps = 0.0;
  double climb_deg = 0.0, bank_deg = 0.0;
  double period_s = 0.05;
  double air_density_kgm3 = 0.0;
  bool as_json = false;
};

/// @throws ConfigError if the file is a whole scenario
void refuse_scenario(const std::filesystem::path& file) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("vehicles:")) continue;
    throw ConfigError(
        fmt::format("trim: '{}' is a scenario, must be the file of one vehicle, as a scenario "
                    "includes it (e.g. assets/vehicles/mh900_like.yaml)",
                    file.string()));
  }
}

/// A scenario's error without that scenario, which the user did not write: the place is the
/// vehicle's file, and keys start at the vehicle.
std::string in_words_of_the_file(const io::PlacedError& error, const std::filesystem::path& file) {
  std::string text = error.what();
  const std::string place = error.where().text();
  if (error.where().file == "scenario") text.replace(0, place.size(), file.string());
  const std::string option = "--set ", own = fmt::format("{}.", kName), path = "vehicles." + own;
  if (text.starts_with(option + own)) text.erase(option.size(), own.size());
  for (std::size_t at; (at = text.find(path)) != std::string::npos;) text.erase(at, path.size());
  return text;
}

/// Loads a vehicle from a file as `include` in a scenario does.
scenario::VehicleConfig load_vehicle(const TrimArguments& arguments, const Registry& registry) {
  if (!std::filesystem::is_regular_file(arguments.file)) {
    throw ConfigError(fmt::format("trim: '{}' is no file", arguments.file.string()));
  }
  refuse_scenario(arguments.file);
  std::string quoted;
  for (const char c : std::filesystem::absolute(arguments.file).string()) {
    quoted += c == '\'' ? std::string("''") : std::string(1, c);
  }
  // The world around the vehicle is read but not built.
  const std::string scenario = fmt::format(
      "vinerow: 1\nname: trim\nworld: {{type: vineyard}}\nvehicles:\n  {}:\n"
      "    include: '{}'\n    spawn: {{x_m: 0, y_m: 0}}\n",
      kName, quoted);
  scenario::Overrides overrides;
  for (const std::string& set : arguments.sets) {
    overrides.sets.push_back(fmt::format("{}.{}", kName, set));
  }
  try {
    return scenario::parse_scenario(scenario, std::filesystem::current_path(), registry, overrides)
        .vehicles.front();
  } catch (const io::PlacedError& error) {
    throw ConfigError(in_words_of_the_file(error, arguments.file));
  }
}

void check_option(bool holds, const char* option, double value, const char* allowed) {
  if (!holds || !std::isfinite(value)) {
    throw ConfigError(fmt::format("trim: --{} = {:g}, must be {}", option, value, allowed));
  }
}

int trim(const TrimArguments& arguments) {
  check_option(std::abs(arguments.climb_deg) < 90.0, "climb", arguments.climb_deg,
               "between -90 and 90 deg");
  check_option(std::abs(arguments.bank_deg) < 90.0, "bank", arguments.bank_deg,
               "between -90 and 90 deg");
  check_option(arguments.period_s > 0.0 && arguments.period_s <= 10.0, "period", arguments.period_s,
               "> 0 and <= 10 s");
  check_option(arguments.speed_mps >= 0.0, "speed", arguments.speed_mps,
               "> 0 m/s (0: the vehicle's cruise speed)");
  check_option(arguments.air_density_kgm3 >= 0.0, "air-density", arguments.air_density_kgm3,
               "> 0 kg/m3 (0: that of the vehicle)");
  const Registry registry = make_registry(arguments.plugins);
  const scenario::VehicleConfig config = load_vehicle(arguments, registry);
  VehicleContext context;
  context.vehicle = kName;
  context.part = kName;
  context.physics_step = Duration{1'000'000};
  const std::unique_ptr<Vehicle> vehicle =
      registry.make_vehicle(config.vehicle.type, config.vehicle.parameters, context);
  const std::string who = arguments.file.filename().string();
  controllers::Aircraft aircraft =
      controllers::read_aircraft(vehicle->description(), context.gravity_mps2, who);
  if (arguments.air_density_kgm3 > 0.0) aircraft.air_density_kgm3 = arguments.air_density_kgm3;
  const controllers::TrimRequest request{
      arguments.speed_mps > 0.0 ? arguments.speed_mps : aircraft.cruise_speed_mps,
      rad_from_deg(arguments.climb_deg), rad_from_deg(arguments.bank_deg)};
  const TrimReport report = make_trim_report(aircraft, request, arguments.period_s, who);
  fmt::print("{}\n", arguments.as_json ? to_json(report) : to_text(report));
  return 0;
}

}  // namespace

void add_trim_command(CLI::App& app, int& exit_status) {
  auto arguments = std::make_shared<TrimArguments>();
  CLI::App* command = app.add_subcommand(
      "trim", "compute steady flight, modes, linear models and limits of a fixed-wing vehicle");
  command->add_option("vehicle", arguments->file, "vehicle file (YAML), as scenarios include it")
      ->required();
  command->add_option("--speed", arguments->speed_mps,
                      "true airspeed, m/s (default: the vehicle's cruise speed)");
  command->add_option("--climb", arguments->climb_deg, "climb angle of the path, deg");
  command->add_option("--bank", arguments->bank_deg, "bank of the turn, deg, right > 0");
  command->add_option("--period", arguments->period_s,
                      "sampling period of the discrete models, s (default: 0.05)");
  command->add_option("--air-density", arguments->air_density_kgm3,
                      "air density, kg/m3 (default: that of the vehicle, 1.225)");
  command->add_option("--set", arguments->sets,
                      "override a value of the vehicle, e.g. --set mass_kg=1.3 (may be given "
                      "several times)");
  command->add_option("--plugin", arguments->plugins, "load a plug-in")->allow_extra_args(false);
  command->add_flag("--json", arguments->as_json, "print JSON, in SI units and rad");
  command->callback([arguments, &exit_status] {
    arguments->file = scenario::find_shipped(arguments->file);
    exit_status = trim(*arguments);
  });
}

}  // namespace vinerow::tools
