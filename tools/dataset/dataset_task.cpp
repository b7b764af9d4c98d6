#include "tools/dataset/dataset_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/sensors/camera/camera.h"

namespace vinerow::dataset {
namespace {

io::YamlNode scalar(std::string text) {
  io::YamlNode node;
  node.kind = io::YamlKind::kScalar;
  node.text = std::move(text);
  return node;
}

}  // namespace

DatasetTask::DatasetTask(const study::OpenStudy& open) : open_(open) {
  if (!open.study.dataset) {
    throw ConfigError(
        fmt::format("{}: has no 'dataset'; add dataset: {{camera: <vehicle>/<camera>}}",
                    open.study.file.string()));
  }
  const scenario::DatasetConfig& config = *open.study.dataset;
  const std::size_t slash = config.camera.find('/');
  vehicle_ = config.camera.substr(0, slash);
  sensor_ = slash == std::string::npos ? "" : config.camera.substr(slash + 1);
  for (std::size_t cell = 0; cell < open.design.cells(); ++cell) check_cell(cell);
}

bool DatasetTask::writes(const char* format) const {
  const auto& formats = config().formats;
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

scenario::Scenario DatasetTask::scenario(std::size_t cell) const {
  scenario::Overrides overrides = open_.design.overrides(cell);
  const std::string key = fmt::format("{}.sensors.{}.", vehicle_, sensor_);
  for (const char* layer : kLayerNames) overrides.values.push_back({key + layer, scalar("true")});
  // Every picture, when it is taken.
  overrides.values.push_back({key + "delay_s", scalar("0")});
  overrides.values.push_back({key + "dropout_share", scalar("0")});
  if (config().every_s) {
    overrides.values.push_back(
        {key + "rate_Hz", scalar(fmt::format("{}", 1.0 / *config().every_s))});
  }
  return open_.source.load(open_.registry, overrides);
}

void DatasetTask::fail(const std::string& sentence) const {
  io::fail_at(open_.study.dataset_mark, "dataset." + sentence);
}

void DatasetTask::check_cell(std::size_t cell) {
  const scenario::Scenario plain = open_.source.load(open_.registry, open_.design.overrides(cell));
  std::vector<std::string> cameras;
  const scenario::NamedPart* found = nullptr;
  for (const scenario::VehicleConfig& vehicle : plain.vehicles) {
    for (const scenario::NamedPart& sensor : vehicle.sensors) {
      if (sensor.part.type != "camera") continue;
      cameras.push_back(vehicle.name + "/" + sensor.name);
      if (cameras.back() == config().camera) found = &sensor;
    }
  }
  if (found == nullptr) {
    fail(fmt::format("camera = '{}', must be a sensor of type camera: {}{}", config().camera,
                     cameras.empty() ? "the scenario has none" : join(cameras),
                     did_you_mean(config().camera, cameras)));
  }
  const sensors::CameraNature nature = sensors::camera_nature(found->part.parameters);
  if (nature.takes_depth_alone) {
    fail(
        fmt::format("camera = '{}' takes pictures of depth alone; choose one of colour, grey or "
                    "a band",
                    config().camera));
  }
  if (writes("kitti") && nature.has_distortion) {
    fail(
        fmt::format("formats has kitti, which knows no distortion: '{}' must have the lens "
                    "brown_conrady with distortion: []",
                    config().camera));
  }
  if (config().every_s) {
    const double steps = *config().every_s / plain.physics_step.s();
    if (std::abs(steps - std::round(steps)) > 1e-6 || std::round(steps) < 1.0) {
      fail(fmt::format("every_s = {:g} s, must be a multiple of the physics step of {:g} s",
                       *config().every_s, plain.physics_step.s()));
    }
  }
  const double period_s = config().every_s.value_or(1.0 / found->part.rate_Hz);
  const int all = static_cast<int>(std::floor(plain.duration_s / period_s + 1e-9)) + 1;
  most_pictures_ = std::max(most_pictures_, std::min(all, config().pictures.value_or(all)));
}

}  // namespace vinerow::dataset
