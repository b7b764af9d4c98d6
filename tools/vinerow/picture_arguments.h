#pragma once
/// Arguments shared by `vinerow render` and `vinerow video`: log, cameras, time span and size.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/playback/run_frames.h"

namespace vinerow::tools {

struct PictureArguments {
  std::filesystem::path log;
  std::vector<std::filesystem::path> plugins;
  std::vector<std::string> cameras;
  double from_s = -1.0, to_s = -1.0;
  int width = 0, height = 0;
};
void add_picture_arguments(CLI::App& command, PictureArguments& arguments);

/// A camera is the name of a camera in the scenario, or keys and values:
/// "kind=chase,vehicle=rover". The latter are added to the log's scenario as `view`, `view2`, ...
/// or under their key `name`, and are checked like cameras of a scenario.
/// @throws ConfigError "--camera kind: must be key=value, ..."
playback::PictureOptions picture_options(const PictureArguments& arguments);

/// render_log(). If a camera given as keys and values is invalid, the message names --camera.
playback::PictureReport render_pictures(const std::filesystem::path& log,
                                        const std::filesystem::path& out, const Registry& registry,
                                        const playback::PictureOptions& options);

}  // namespace vinerow::tools
