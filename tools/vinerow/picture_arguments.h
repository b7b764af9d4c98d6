#pragma once
/// What `vinerow render` and `vinerow video` share: which log, cameras, span and size.

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

/// A camera is a name of the scenario's, or keys and values: "kind=chase,vehicle=rover". Those
/// become cameras `view`, `view2`, ... of the log's scenario, or are called by their key `name`,
/// and are checked as a scenario's.
/// @throws ConfigError "--camera kind: must be key=value, ..."
playback::PictureOptions picture_options(const PictureArguments& arguments);

/// render_log(); where a camera of one's own is at fault, the sentence names --camera.
playback::PictureReport render_pictures(const std::filesystem::path& log,
                                        const std::filesystem::path& out, const Registry& registry,
                                        const playback::PictureOptions& options);

}  // namespace vinerow::tools
