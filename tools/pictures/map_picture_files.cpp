#include "tools/pictures/map_picture_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/io/files/output_folder.h"
#include "engine/playback/frame_words.h"
#include "engine/render/scene.h"
#include "tools/pictures/map_pictures.h"
#include "worlds/mapping/folder/map_folder.h"
#include "worlds/mapping/folder/map_points.h"

namespace vinerow::tools {
namespace {

namespace fs = std::filesystem;

const PhaseReport* find_phase(const run::RunResult& result, const std::string& name) {
  const auto at = std::find_if(result.phases.begin(), result.phases.end(),
                               [&](const PhaseReport& phase) { return phase.name == name; });
  return at == result.phases.end() ? nullptr : &*at;
}

/// Point cloud that the phase took as input. @returns nullopt if it was never made
std::optional<fs::path> cloud_of(const scenario::PhaseConfig& phase, const run::RunResult& result) {
  for (const scenario::ProductSource& source : phase.takes) {
    const PhaseReport* source_phase = find_phase(result, source.phase);
    if (source.kind == ProductKind::kCloud && source_phase != nullptr && source_phase->product) {
      return source_phase->product->file;
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<fs::path> write_map_pictures(const mapping::CloudMap& map,
                                         const mapping::ParcelCloud& cloud,
                                         const mapping::OccupancyOptions& options,
                                         const std::string& title, const fs::path& folder) {
  io::make_folder(folder);
  std::vector<fs::path> files;
  const auto add = [&](const char* name, const render::Image& image) {
    files.push_back(folder / name);
    render::write_png(files.back().string(), image);
  };
  add("top.png", draw_top(map, cloud, title + ": rows from above"));
  add("classes.png", draw_classes(map, cloud, title + ": point cloud"));
  add("mesh.png", draw_meshes(map, cloud, title + ": row meshes"));
  if (!map.map.occupancy.empty()) {
    add("grid.png", draw_map_grid(map, options, title + ": occupancy grid"));
  }
  return files;
}

std::vector<fs::path> write_job_pictures(const scenario::Scenario& scenario,
                                         const run::RunResult& result) {
  std::vector<fs::path> files;
  for (const scenario::PhaseConfig& phase : scenario.phases) {
    const PhaseReport* report = find_phase(result, phase.name);
    if (report == nullptr || !report->product || report->product->kind != ProductKind::kMap) {
      continue;
    }
    const fs::path& folder = report->product->file;
    const auto cloud = cloud_of(phase, result);
    if (folder.empty() || !cloud) continue;
    const std::optional<mapping::MapPoints> points = mapping::load_map_points(folder);
    if (!points) continue;
    const auto drawn = write_map_pictures(
        mapping::load_map(folder), mapping::read_classified_cloud(*points, *cloud),
        points->occupancy, playback::picture_title(scenario), folder);
    files.insert(files.end(), drawn.begin(), drawn.end());
  }
  return files;
}

}  // namespace vinerow::tools
