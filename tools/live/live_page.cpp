#include "tools/live/live_page.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "engine/core/error.h"
#include "engine/playback/run_frames.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"
#include "tools/replay/page_text.h"
#include "tools/replay/replay_assets.h"
#include "tools/replay/replay_index.h"
#include "tools/replay/replay_scene.h"
#include "tools/replay/replay_textures.h"
#include "tools/replay/replay_tracks.h"

VINEROW_ASSET(live_markup);
VINEROW_ASSET(live_style);
VINEROW_ASSET(live_cdr);
VINEROW_ASSET(live_socket);
VINEROW_ASSET(live_clock);
VINEROW_ASSET(live_track);
VINEROW_ASSET(live_scene);
VINEROW_ASSET(live_series);
VINEROW_ASSET(live_fields);
VINEROW_ASSET(live_plot);
VINEROW_ASSET(live_plots);
VINEROW_ASSET(live_events);
VINEROW_ASSET(live_drive);
VINEROW_ASSET(live_run_bar);
VINEROW_ASSET(live_live);

namespace vinerow::tools {
namespace {

using nlohmann::json;

constexpr const char* kHtml = "text/html; charset=utf-8";

std::vector<EmbeddedFile> live_scripts() {
  return {{"cdr.js", VINEROW_ASSET_TEXT(live_cdr)},
          {"socket.js", VINEROW_ASSET_TEXT(live_socket)},
          {"clock.js", VINEROW_ASSET_TEXT(live_clock)},
          {"track.js", VINEROW_ASSET_TEXT(live_track)},
          {"live_scene.js", VINEROW_ASSET_TEXT(live_scene)},
          {"series.js", VINEROW_ASSET_TEXT(live_series)},
          {"fields.js", VINEROW_ASSET_TEXT(live_fields)},
          {"plot.js", VINEROW_ASSET_TEXT(live_plot)},
          {"plots.js", VINEROW_ASSET_TEXT(live_plots)},
          {"events.js", VINEROW_ASSET_TEXT(live_events)},
          {"drive.js", VINEROW_ASSET_TEXT(live_drive)},
          {"run_bar.js", VINEROW_ASSET_TEXT(live_run_bar)},
          {"live.js", VINEROW_ASSET_TEXT(live_live)}};
}

/// Present poses as a trace with one sample, the form in which a replay takes poses.
playback::LogTrace present_poses(const Simulation& simulation) {
  playback::LogTrace trace;
  trace.first = trace.last = simulation.now();
  for (const std::unique_ptr<VehicleRuntime>& runtime : simulation.vehicles()) {
    const Vehicle& vehicle = runtime->vehicle();
    playback::VehicleTrace& own = trace.vehicles[runtime->name()];
    own.truth.times = own.links.times = {simulation.now()};
    vehicle.read_truth(own.truth.values.emplace_back());
    std::vector<Pose>& X_WL = own.links.values.emplace_back().X_WL;
    X_WL.resize(vehicle.links().size());
    vehicle.read_links(X_WL);
  }
  return trace;
}

/// What the page needs of a run, independent of it.
struct PageInput {
  scenario::Scenario scenario;
  std::shared_ptr<const WorldModel> world;
  playback::LogTrace trace;  ///< poses when the run begins
};

/// Vehicles of the index: of a track only what does not change with time.
json live_vehicles(const PageInput& run,
                   const std::vector<std::unique_ptr<Vehicle>>& vehicles_of_run, json tracks) {
  json vehicles = json::array();
  for (const json& track : tracks) {
    const auto index = track.at("index").get<std::size_t>();
    const Pose& X_WB =
        run.trace.vehicles.at(run.scenario.vehicles.at(index).name).truth.values.front().X_WB;
    json& vehicle = vehicles.emplace_back();
    for (const char* key :
         {"name", "type", "index", "colour", "flies", "foot_m", "size_m", "top_m"}) {
      vehicle[key] = track.at(key);
    }
    const Eigen::Vector3d& p = X_WB.p;
    const Eigen::Quaterniond& q = X_WB.q;
    vehicle["pose"] = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
    if (const auto& limit = vehicles_of_run.at(index)->description().max_speed_mps) {
      vehicle["max_speed_mps"] = *limit;
    }
    for (const json& link : track.at("links")) {
      vehicle["links"].push_back({{"name", link.at("name")}, {"pose", link.at("pose")}});
    }
    if (!vehicle.contains("links")) vehicle["links"] = json::array();
  }
  return vehicles;
}

live::WebFile file_of(std::string path, const char* media_type, std::string_view bytes) {
  return {std::move(path), media_type, std::string(bytes)};
}

/// A page without picture.
std::vector<live::WebFile> absent_page(const std::string& reason) {
  return {file_of(
      "/", kHtml,
      page_head("Vinerow live", "") +
          fmt::format("<p>There is no page: {}.</p>\n</body>\n</html>\n", escaped(reason)))};
}

std::vector<live::WebFile> page_files(const PageInput& run, const Registry& registry) {
  const std::vector<std::unique_ptr<Vehicle>> vehicles =
      playback::vehicles_of_scenario(run.scenario, registry);
  const ReplayInput input{&run.scenario, run.world.get(), &vehicles, &run.trace, {}};
  const ReplayLimits limits;
  ReplayScene scene = make_replay_scene(input, limits);
  ReplayTracks tracks = make_replay_tracks(input, limits);
  ReplayTextures textures = make_replay_textures(run.world->daylight);

  json index = replay_index(run.scenario.name, *run.world, textures);
  index["vehicles"] = live_vehicles(run, vehicles, std::move(tracks.index["vehicles"]));
  index["notes"] = scene.notes;

  std::vector<live::WebFile> files = {
      file_of("/", kHtml, VINEROW_ASSET_TEXT(live_markup)),
      file_of("/live.css", "text/css; charset=utf-8", VINEROW_ASSET_TEXT(live_style)),
      file_of("/replay.css", "text/css; charset=utf-8", replay_style()),
      file_of("/three_licence.txt", "text/plain; charset=utf-8", three_notice())};
  for (const std::vector<EmbeddedFile>& scripts :
       {three_scripts(), picture_scripts(), live_scripts()}) {
    for (const EmbeddedFile& script : scripts) {
      files.push_back(
          file_of(fmt::format("/{}", script.name), "text/javascript; charset=utf-8", script.text));
    }
  }
  files.push_back({"/index.json", "application/json",
                   index.dump(-1, ' ', false, json::error_handler_t::replace)});
  files.push_back({"/scene.glb", "model/gltf-binary", std::move(scene.glb)});
  files.push_back({"/textures.bin", "application/octet-stream", std::move(textures.bytes)});
  return files;
}

}  // namespace

std::function<std::vector<live::WebFile>()> live_page(const Simulation& simulation,
                                                      const Registry& registry) {
  auto run = std::make_shared<const PageInput>(
      PageInput{simulation.scenario(), simulation.built_world().model, present_poses(simulation)});
  return [run, &registry] {
    if (!has_replay()) return absent_page(replay_absence());
    try {
      return page_files(*run, registry);
    } catch (const ConfigError& error) {
      // A file of a vehicle may have changed since the run began, which must not end the run.
      return absent_page(error.what());
    }
  };
}

}  // namespace vinerow::tools
