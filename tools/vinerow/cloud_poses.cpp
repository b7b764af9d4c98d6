#include "tools/vinerow/cloud_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "controllers/planning/survey/survey_plan.h"
#include "engine/core/error.h"
#include "engine/playback/log_trace.h"
#include "engine/playback/run_frames.h"
#include "engine/record/log_reader.h"
#include "engine/sim/picture_collector.h"
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
        channel.messages == 0 || playback::is_truth_of_reading(log, channel.topic)) {
      continue;
    }
    const std::size_t slash = channel.topic.find('/', 1);
    cameras.push_back(
        {channel.topic.substr(1, slash - 1), channel.topic.substr(slash + 1), channel.topic});
  }
  return cameras;
}

const scenario::NamedPart& part_of(const scenario::Scenario& scenario, const Camera& camera,
                                   const std::filesystem::path& log) {
  for (const scenario::VehicleConfig& vehicle : scenario.vehicles) {
    if (vehicle.name != camera.vehicle) continue;
    for (const scenario::NamedPart& sensor : vehicle.sensors) {
      if (sensor.name == camera.sensor) return sensor;
    }
  }
  throw ConfigError(
      fmt::format("{}: its scenario has no sensor '{}'", log.string(), camera.name()));
}

/// Estimated camera positions at these times, from the latest estimate logged before each.
/// @returns empty if the log has no estimates, or none before one of the times
std::vector<Eigen::Vector3d> estimated_places(const record::LogReader& log,
                                              const std::string& topic,
                                              const std::vector<Time>& times,
                                              const Eigen::Vector3d& p_BS) {
  std::vector<Eigen::Vector3d> places;
  playback::Trace<Odometry> estimates;
  const auto& channels = log.info().channels;
  const bool is_logged =
      std::any_of(channels.begin(), channels.end(), [&](const record::ChannelInfo& channel) {
        return channel.topic == topic && channel.messages > 0;
      });
  if (!is_logged) return places;
  log.read<Odometry>(topic, [&](Time t, const Odometry& pose) { estimates.add(t, pose); });
  for (const Time t : times) {
    const auto next = std::upper_bound(estimates.times.begin(), estimates.times.end(), t);
    if (next == estimates.times.begin()) return {};
    const auto k = static_cast<std::size_t>(next - estimates.times.begin()) - 1;
    places.push_back(estimated_place(estimates.values[k], (t - estimates.times[k]).s(), p_BS));
  }
  return places;
}

}  // namespace

PictureSet pictures_of_log(const std::filesystem::path& log, const Registry& registry,
                           const std::string& vehicle, const std::string& sensor) {
  const record::LogReader reader(log);
  const std::vector<Camera> all = find_cameras(reader);
  if (all.empty()) {
    throw ConfigError(fmt::format(
        "{}: contains no survey: no camera_trigger of the run took a picture", log.string()));
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
            ? fmt::format("{}: camera '{}/{}' took no picture; cameras that did: {}", log.string(),
                          vehicle.empty() ? "*" : vehicle, sensor.empty() ? "*" : sensor, names)
            : fmt::format("{}: several cameras took pictures ({}), choose one with --vehicle "
                          "and --sensor",
                          log.string(), names));
  }
  PictureSet pictures;
  const scenario::Scenario scenario = playback::scenario_of_log(log, registry);
  const scenario::NamedPart& part = part_of(scenario, chosen.front(), log);
  pictures.camera = read_survey_camera(part.part.parameters);
  std::vector<Time> times;
  reader.read<CameraShot>(chosen.front().topic, [&](Time t, const CameraShot& shot) {
    if (shot.index < 0) return;
    pictures.X_WS.push_back(shot.X_WS);
    times.push_back(t);
  });
  pictures.estimated_W = estimated_places(reader, "/" + chosen.front().vehicle + "/estimate", times,
                                          place_of_sensor(part.part.parameters));
  pictures.source = fmt::format("{} of {}", chosen.front().name(), log.string());
  return pictures;
}

PictureSet pictures_of_plan(const controllers::SurveyPlan& plan, const SurveyCamera& camera,
                            const std::filesystem::path& file) {
  PictureSet pictures;
  pictures.camera = camera;
  for (const controllers::SurveyShot& shot : plan.shots) {
    pictures.X_WS.push_back(
        {quaternion_from_rpy({0.0, 0.5 * std::numbers::pi, shot.yaw_rad}), shot.p_W});
  }
  pictures.source = "plan of " + file.string();
  return pictures;
}

PictureSet pictures_of_plan(const scenario::Scenario& scenario, const std::filesystem::path& file,
                            const Registry& registry, const std::string& vehicle) {
  SurveyArguments arguments;
  arguments.scenario.file = file;
  arguments.vehicle = vehicle;
  Simulation simulation(scenario, registry);
  const SurveyTask task = task_of_scenario(arguments, scenario, simulation);
  const auto plan = controllers::plan_survey(task.request, task.start_W, task.ground);
  if (!plan) throw ConfigError("survey: " + plan.reason());
  return pictures_of_plan(*plan, task.request.camera, file);
}

}  // namespace vinerow::tools
