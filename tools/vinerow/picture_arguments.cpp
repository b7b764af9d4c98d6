#include "tools/vinerow/picture_arguments.h"

#include <fmt/format.h>

#include "engine/core/error.h"
#include "tools/vinerow/number_checks.h"

namespace vinerow::tools {
namespace {

/// Parts between commas; commas inside brackets do not split.
std::vector<std::string> split_outside_brackets(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : text) {
    if (c == '[') ++depth;
    if (c == ']') --depth;
    if (c == ',' && depth == 0) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// Adds a camera given as keys and values to the scenario. @returns its name
std::string add_own_camera(const std::string& text, const std::string& default_name,
                           std::vector<std::string>& sets) {
  std::string name = default_name, keys;
  for (const std::string& part : split_outside_brackets(text)) {
    const std::size_t equals = part.find('=');
    if (equals == 0 || equals == std::string::npos) {
      throw ConfigError(
          fmt::format("--camera {}: '{}' must be key=value, as in "
                      "kind=chase,vehicle=rover,distance_m=4",
                      text, part));
    }
    const std::string key = part.substr(0, equals), value = part.substr(equals + 1);
    if (key == "name") {
      name = value;
    } else {
      keys += fmt::format("{}{}: {}", keys.empty() ? "" : ", ", key, value);
    }
  }
  sets.push_back(fmt::format("pictures.cameras.{}={{{}}}", name, keys));
  return name;
}

}  // namespace

void add_picture_arguments(CLI::App& command, PictureArguments& arguments) {
  command
      .add_option("log", arguments.log, "log.mcap of a run, complete or truncated, or its folder")
      ->required();
  command
      .add_option("--camera", arguments.cameras,
                  "only this camera of the scenario, or a new one as key=value, such as "
                  "kind=chase,vehicle=rover,distance_m=4 (may be given several times)")
      ->allow_extra_args(false);
  command.add_option("--from", arguments.from_s, "first simulated time of a frame, s")
      ->check(not_negative());
  command.add_option("--to", arguments.to_s, "last simulated time of a frame, s")
      ->check(not_negative());
  command.add_option("--width", arguments.width, "width of the frames, pixels")
      ->check(CLI::Range(16, 8192));
  command.add_option("--height", arguments.height, "height of the frames, pixels")
      ->check(CLI::Range(16, 8192));
  command
      .add_option("--plugin", arguments.plugins,
                  "load a plug-in in addition to those the run names")
      ->allow_extra_args(false);
}

playback::PictureOptions picture_options(const PictureArguments& arguments) {
  playback::PictureOptions options;
  int own = 0;
  for (const std::string& camera : arguments.cameras) {
    if (camera.find('=') == std::string::npos) {
      options.cameras.push_back(camera);
      continue;
    }
    const std::string name = ++own == 1 ? "view" : fmt::format("view{}", own);
    options.cameras.push_back(add_own_camera(camera, name, options.overrides.sets));
  }
  if (arguments.from_s >= 0.0) options.from_s = arguments.from_s;
  if (arguments.to_s >= 0.0) options.to_s = arguments.to_s;
  if (arguments.width > 0) options.width = arguments.width;
  if (arguments.height > 0) options.height = arguments.height;
  return options;
}

playback::PictureReport render_pictures(const std::filesystem::path& log,
                                        const std::filesystem::path& out, const Registry& registry,
                                        const playback::PictureOptions& options) {
  try {
    return playback::render_log(log, out, registry, options);
  } catch (const ConfigError& error) {
    // The camera was passed on as an override that the user did not type.
    const std::string words = error.what();
    for (const std::string& set : options.overrides.sets) {
      const std::string prefix = fmt::format("--set {}: pictures.cameras.", set);
      if (words.starts_with(prefix)) {
        throw ConfigError("--camera: " + words.substr(prefix.size()));
      }
    }
    throw;
  }
}

}  // namespace vinerow::tools
