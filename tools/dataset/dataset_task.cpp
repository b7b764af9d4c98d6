#include "tools/dataset/dataset_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/sensors/camera/camera.h"

namespace vinerow::dataset {
namespace {

/// More pictures than this are a mistake; their numbers and counts are ints.
constexpr double kMostPictures = 1e9;

/// Whether the scenario or the study gives a value of the world's plant_seed in a cell.
bool gives_plant_seed(const study::OpenStudy& open, std::size_t cell) {
  const auto has = [](const io::YamlNode* world) {
    return world != nullptr && world->is_mapping() && world->find("plant_seed") != nullptr;
  };
  bool given = has(open.source.tree().find("world"));
  for (const scenario::OverrideValue& value : open.design.overrides(cell).values) {
    if (value.path == "world") given = has(&value.value);
    if (value.path == "world.plant_seed") given = !value.value.is_null();
  }
  return given;
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
  const double all = static_cast<double>(open.design.cells()) * most_pictures_;
  if (all > kMostPictures) {
    fail(
        fmt::format("pictures: {} runs of up to {} pictures, must make at most {:.0f} together; "
                    "set dataset.pictures or a longer dataset.every_s",
                    open.design.cells(), most_pictures_, kMostPictures));
  }
}

bool DatasetTask::writes(const char* format) const {
  const auto& formats = config().formats;
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

scenario::Scenario DatasetTask::scenario(std::size_t cell) const {
  scenario::Overrides overrides = open_.design.overrides(cell);
  const auto set = [&](const std::string& path, const std::string& text) {
    io::YamlNode value;
    value.kind = io::YamlKind::kScalar;
    value.text = text;
    value.mark = open_.study.dataset_mark;
    overrides.values.push_back({path, std::move(value)});
  };
  const std::string key = fmt::format("{}.sensors.{}.", vehicle_, sensor_);
  for (const char* layer : kLayerNames) set(key + layer, "true");
  // Every picture, when it is taken.
  set(key + "delay_s", "0");
  set(key + "dropout_share", "0");
  // Labels are exact, and so is the depth that key points are judged by.
  for (const char* error : {"depth_disparity_std_px", "depth_dropout_share", "depth_min_m"}) {
    set(key + error, "0");
  }
  set(key + "depth_max_m", "65.535");
  if (config().every_s) set(key + "rate_Hz", fmt::format("{}", 1.0 / *config().every_s));
  if (plant_seed(cell)) set("world.plant_seed", fmt::format("{}", *plant_seed(cell)));
  return open_.source.load(open_.registry, overrides);
}

void DatasetTask::fail(const std::string& sentence) const {
  io::fail_at(open_.study.dataset_mark, "dataset." + sentence);
}

sensors::CameraNature DatasetTask::nature_of(const scenario::NamedPart& camera) const {
  try {
    return sensors::camera_nature(camera.part.parameters,
                                  fmt::format("{}.sensors.{}", vehicle_, sensor_));
  } catch (const ConfigError& error) {
    io::fail_at(camera.part.where, error.what());
  }
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
  const sensors::CameraNature nature = nature_of(*found);
  readouts_s_.push_back(nature.readout_s);
  if (nature.takes_depth_alone) {
    fail(
        fmt::format("camera = '{}' takes pictures of depth alone; choose one of colour, mono "
                    "or a band",
                    config().camera));
  }
  if (writes("kitti") && nature.has_distortion) {
    fail(
        fmt::format("formats has kitti, which knows no distortion: '{}' must have the lens "
                    "brown_conrady with distortion: []",
                    config().camera));
  }
  if (config().every_s) {
    const Duration period = period_of_rate(1.0 / *config().every_s);
    if (period.ns <= 0 || period.ns % plain.physics_step.ns != 0) {
      fail(fmt::format("every_s = {} s, must be a multiple of the physics step of {} s",
                       *config().every_s, plain.physics_step.s()));
    }
    if (period.s() < nature.busy_s) {
      fail(
          fmt::format("every_s = {} s, must be at least the {:g} s of an exposure and a readout "
                      "of '{}'",
                      *config().every_s, nature.busy_s, config().camera));
    }
  }
  add_plant_seed(cell, plain.world);
  const double rate_Hz = config().every_s ? 1.0 / *config().every_s : found->part.rate_Hz;
  const double pictures = pictures_of(plain, rate_Hz);
  if (pictures > kMostPictures) {
    fail(
        fmt::format("every_s makes {:.3g} pictures in the {:g} s of a run, must make at most "
                    "{:.0f}; set dataset.pictures or a longer dataset.every_s",
                    pictures, plain.duration_s, kMostPictures));
  }
  most_pictures_ = std::max(most_pictures_, static_cast<int>(pictures));
}

/// Most pictures of a cell's run; a double, since long runs have more than an int holds.
double DatasetTask::pictures_of(const scenario::Scenario& plain, double rate_Hz) const {
  const double all = std::floor(plain.duration_s * rate_Hz + 1e-9) + 1.0;
  return config().pictures ? std::min(all, static_cast<double>(*config().pictures)) : all;
}

void DatasetTask::add_plant_seed(std::size_t cell, const scenario::PartConfig& world) {
  plant_seeds_.emplace_back();
  for (const ParameterSpec& spec : world.parameters.specs()) {
    if (spec.name != "plant_seed" || spec.kind != ParameterKind::kInteger) continue;
    if (gives_plant_seed(open_, cell)) {
      const auto given = std::get<std::int64_t>(*world.parameters.find(spec.name));
      plant_seeds_.back() = static_cast<std::uint64_t>(given);
      continue;
    }
    const std::uint64_t seed = open_.design.seed_of(cell);
    try {
      check_parameter(spec, static_cast<std::int64_t>(seed));
    } catch (const ConfigError&) {
      io::fail_at(open_.study.dataset_mark,
                  fmt::format("seed {} is too large to be also the world's plant_seed; choose "
                              "smaller seeds, or set world.plant_seed",
                              seed));
    }
    plant_seeds_.back() = seed;
  }
}

}  // namespace vinerow::dataset
