#pragma once
/// Replay of a run as a 3D scene that a browser plays without a network: world, vehicles, their
/// plans and trails, with a time slider, and free and following cameras.

#include <memory>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/vehicle.h"
#include "engine/playback/log_trace.h"
#include "engine/scenario/scenario.h"

namespace vinerow::tools {

/// Named time span of the run, marked on the time slider.
struct ReplayPhase {
  std::string name;
  double begin_s = 0.0;
  double end_s = 0.0;
  std::string state;  ///< "succeeded", "failed", "blocked", "stopped"
};

/// Data of a replay. Pointers are used while the section is made and not kept.
struct ReplayInput {
  const scenario::Scenario* scenario = nullptr;
  const WorldModel* world = nullptr;
  const std::vector<std::unique_ptr<Vehicle>>* vehicles = nullptr;  ///< order of the scenario's
  const playback::LogTrace* trace = nullptr;                        ///< with these vehicles
  std::vector<ReplayPhase> phases;
};

/// Limits that keep a page quick to open. Content beyond them is made coarser, and a note reports
/// it.
struct ReplayLimits {
  std::size_t leaf_bytes = 1'900'000;   ///< meshes of leaves
  std::size_t solid_bytes = 3'000'000;  ///< all other meshes except the terrain
  int terrain_samples = 40'000;
  std::size_t track_bytes = 1'600'000;  ///< poses over time
  std::size_t plan_points = 60'000;     ///< of all plans
};

/// Whether this program was built with the library that draws replays, and the reason if not.
bool has_replay();
std::string replay_absence();

/// HTML (style, canvas, data and scripts; a few megabytes) for the body of a page, once per page.
/// It refers to nothing outside itself. The same input gives the same bytes. Without has_replay()
/// it is a paragraph that gives the reason.
std::string replay_section(const ReplayInput& input, const ReplayLimits& limits = {});

/// Complete page that contains only the replay.
std::string replay_page(const ReplayInput& input, const ReplayLimits& limits = {});

}  // namespace vinerow::tools
