#include "tools/vinerow/cloud_poses.h"

#include <fmt/format.h>

#include <numbers>

#include "controllers/planning/survey_plan.h"
#include "engine/core/error.h"
#include "engine/record/log_reader.h"
#include "engine/sim/log_trace.h"
#include "engine/sim/pictures.h"
#include "engine/sim/simulation.h"
#include "tools/vinerow/survey_task.h"

namespace vinerow::tools {
namespace {

/// A camera that has taken pictures.
struct Camera {
  std::string vehicle, sensor, topic;
  std::string name() const { return vehicle + "/" + sensor; }
};

std::vector<Camera> find_cameras(const record::LogReader& log) {
  std::vector<Camera> cameras;
  for (const record::ChannelInfo& channel : log.info().channels) {
    const auto type = channel.metadata.find("vinerow_type");
    if (type == channel.metadata.end() || type->second != CameraShot::kType ||
        channel.messages == 0 || is_truth_beside(log, channel.topic)) {
      continue;
    }
    const std::size_t slash = channel.topic.find('/', 1);
    cameras.push_back(
        {channel.topic.substr(1, slash - 1), channel.topic.substr(slash + 1), channel.topic});
  }
  return cameras;
}

SurveyCamera camera_of(const io::Scenario& scenario, const Camera& camera,
                       const std::filesystem::path& log) {
  for (const io::VehicleConfig& vehicle : scenario.vehicles) {
    if (vehicle.name != camera.vehicle) continue;
    for (const io::NamedPart& sensor : vehicle.sensors) {
      if (sensor.name == camera.sensor) return read_survey_camera(sensor.part.parameters);
    }
  }
  throw ConfigError(
      fmt::format("{}: its scenario has no sensor '{}'", log.string(), camera.name()));
}

}  // namespace

PictureSet pictures_of_log(const std::filesystem::path& log, const Registry& registry,
                           const std::string& vehicle, const std::string& sensor) {
  const record::LogReader reader(log);
  const std::vector<Camera> all = find_cameras(reader);
  if (all.empty()) {
    throw ConfigError(fmt::format(
        "{}: holds no survey: no camera_trigger of the run has taken a picture", log.string()));
  }
  std::vector<Camera> chosen;
  std::string names;
  for (const Camera& camera : all) {
    names += (names.empty() ? "" : ", ") + camera.name();
    if ((vehicle.empty() || camera.vehicle == vehicle) &&
        (sensor.empty() || camera.sensor == sensor)) {
      chosen.push_back(camera);
    }
  }
  if (chosen.size() != 1) {
    throw ConfigError(
        chosen.empty()
            ? fmt::format("{}: camera '{}/{}' has taken no picture there; those that have: {}",
                          log.string(), vehicle.empty() ? "*" : vehicle,
                          sensor.empty() ? "*" : sensor, names)
            : fmt::format("{}: several cameras have taken pictures ({}), choose one by --vehicle "
                          "and --sensor",
                          log.string(), names));
  }
  PictureSet pictures;
  pictures.camera = camera_of(scenario_of_log(log, registry), chosen.front(), log);
  reader.read<CameraShot>(chosen.front().topic, [&](Time, const CameraShot& shot) {
    if (shot.index >= 0) pictures.X_WS.push_back(shot.X_WS);
  });
  pictures.source = fmt::format("{} of {}", chosen.front().name(), log.string());
  return pictures;
}

PictureSet pictures_of_plan(const io::Scenario& scenario, const std::filesystem::path& file,
                            const Registry& registry, const std::string& vehicle) {
  SurveyArguments arguments;
  arguments.scenario.file = file;
  arguments.vehicle = vehicle;
  Simulation simulation(scenario, registry);
  const SurveyTask task = task_of_scenario(arguments, scenario, simulation);
  const auto plan = plan_survey(task.request, task.start_W, task.ground);
  if (!plan) throw ConfigError("survey: " + plan.reason());
  PictureSet pictures;
  pictures.camera = task.request.camera;
  for (const SurveyShot& shot : plan->shots) {
    pictures.X_WS.push_back(
        {quaternion_from_rpy({0.0, 0.5 * std::numbers::pi, shot.yaw_rad}), shot.p_W});
  }
  pictures.source = "plan of " + file.string();
  return pictures;
}

}  // namespace vinerow::tools
