#pragma once
/// Rendering of a run's frames from its log, shared by `vinerow run` and `vinerow render`.

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/vehicle.h"
#include "engine/scenario/scenario.h"

namespace vinerow::render {
struct Image;
}

namespace vinerow {
class RunShelf;
}

namespace vinerow::playback {

/// Options that replace settings of the scenario in the log.
struct PictureOptions {
  std::vector<std::string> cameras;            ///< names; if empty, all cameras of the scenario
  std::optional<std::vector<double>> times_s;  ///< instead of the scenario's schedule
  std::optional<double> every_s;
  std::optional<double> from_s;  ///< no frame before; every_s counts from here
  std::optional<double> to_s;    ///< no frame after
  std::optional<int> width;
  std::optional<int> height;
  scenario::Overrides overrides;  ///< applied to the log's scenario, e.g. for additional cameras
  /// Receives each frame; no file is written then.
  std::function<void(const render::Image&)> take_frame;
  std::function<void(int done, int total)> progress;
  std::function<bool()> interrupted;  ///< called before each frame; true ends the drawing
  std::shared_ptr<RunShelf> shelf;    ///< has the world, if the run has just ended; may be null
};

struct PictureReport {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> digests;  ///< of the pixels, same order
  std::string note;                  ///< reason for missing pictures
  std::string write_failure;         ///< why a frame could not be stored; empty if all were
  double wall_s = 0.0;
};

/// Draws the frames of a log into `out`, named "<camera>_<milliseconds>.png".
/// @throws ConfigError if the log cannot be read or names parts that the registry does not have
PictureReport render_log(const std::filesystem::path& log, const std::filesystem::path& out,
                         const Registry& registry, const PictureOptions& options);

/// A camera of a scenario. A scenario that lacks "chase" gets one behind its first vehicle.
/// @throws ConfigError "no camera 'tpo' in scenario 'demo'; did you mean 'top'? (known: top)"
scenario::CameraConfig find_camera(const scenario::Scenario& scenario, const std::string& name);

/// Scenario that a log contains. @param overrides  applied to it and checked like it
scenario::Scenario scenario_of_log(const std::filesystem::path& log, const Registry& registry,
                                   const scenario::Overrides& overrides = {});

/// Vehicles of a scenario, built but not spawned: their links and descriptions, in its order.
std::vector<std::unique_ptr<Vehicle>> vehicles_of_scenario(const scenario::Scenario& scenario,
                                                           const Registry& registry);

}  // namespace vinerow::playback
