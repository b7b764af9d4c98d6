#include "tools/vinerow/export_clouds.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/io/files/output_folder.h"
#include "engine/playback/log_trace.h"
#include "engine/playback/run_frames.h"
#include "engine/record/cdr.h"
#include "engine/record/log_reader.h"
#include "engine/sim/simulation.h"
#include "tools/export/log_mountings.h"
#include "tools/export/map_cloud.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

/// Frame of the first cloud of a topic; "" without clouds.
std::string frame_of(record::McapReader& log, const TopicSource& source) {
  std::optional<std::string> frame;
  log.for_each_message(source.channels, [&](const record::McapMessage& message) {
    if (frame) return;
    record::CdrReader in(message.data);
    in.read<std::int32_t>();
    in.read<std::uint32_t>();
    frame = std::string(in.read_text());
  });
  return frame.value_or("");
}

std::unique_ptr<MapCloudFile> file_of(const ExportArguments& arguments) {
  if (!arguments.las) {
    io::make_folder_of(arguments.out);
    return make_table_cloud(arguments.out);
  }
  std::optional<CrsPlace> place;
  if (!arguments.crs.empty()) {
    // The log does not name the origin; the world that its scenario describes has it.
    const Registry registry = registry_of_run(arguments.log, {});
    place = {arguments.crs,
             build_world(playback::scenario_of_log(arguments.log, registry), registry)->origin};
  }
  std::unique_ptr<MapCloudFile> file = make_las_cloud(arguments.out, place);
  io::make_folder_of(arguments.out);
  return file;
}

}  // namespace

void write_map_cloud(record::McapReader& log, const std::string& topic, const TopicSource& source,
                     const ExportArguments& arguments) {
  const auto fail = [&](const std::string& sentence) {
    throw ConfigError(fmt::format("{}: topic '{}' {}", arguments.log.string(), topic, sentence));
  };
  const std::string frame = frame_of(log, source);
  if (frame.empty()) fail("has no clouds");
  const std::vector<Mounting> mountings = read_mountings(log);
  const auto mounting =
      std::find_if(mountings.begin(), mountings.end(),
                   [&](const Mounting& candidate) { return candidate.sensor == frame; });
  if (mounting == mountings.end()) {
    fail(fmt::format("has clouds in the frame '{}', which /tf_static does not place on a vehicle",
                     frame));
  }
  const std::string vehicle = mounting->body.substr(0, mounting->body.rfind('/'));
  std::string poses_topic = arguments.poses;
  if (poses_topic.empty()) {
    poses_topic = "/" + vehicle + "/truth";
  } else if (!poses_topic.starts_with('/')) {
    poses_topic = "/" + poses_topic;
  }
  if (!poses_topic.starts_with("/" + vehicle + "/")) {
    fail(fmt::format("has clouds of '{}', whose poses '{}' does not hold", vehicle, poses_topic));
  }
  playback::Trace<Odometry> poses;
  record::LogReader(arguments.log).read<Odometry>(poses_topic, [&](Time t, const Odometry& pose) {
    poses.add(t, pose);
  });
  if (poses.empty()) {
    throw ConfigError(
        fmt::format("{}: topic '{}' has no poses", arguments.log.string(), poses_topic));
  }
  MapCloud cloud(file_of(arguments), std::move(poses), mounting->X_BS);
  add_messages(log, topic, source, arguments, cloud);
  if (!cloud.has_begun()) fail("has no clouds between --from and --to");
  fmt::print("{}  {} points in {}, by {}\n", arguments.out.string(), cloud.finish(),
             arguments.crs.empty() ? "the frame of the map" : arguments.crs, poses_topic);
  if (cloud.without_pose() > 0) {
    fmt::print(stderr,
               "vinerow: {} points before the first or after the last pose of {} were left out\n",
               cloud.without_pose(), poses_topic);
  }
}

}  // namespace vinerow::tools
