#pragma once
/// Small parts for tests of missions: jobs that make a map, fail, or report their inputs, a camera
/// that takes a picture a second, a controller that publishes which map its vehicle has.

#include <memory>
#include <string>

#include "engine/api/map.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/sensors.h"
#include "tests/engine/sim/small_parts.h"

namespace vinerow::test {

/// A picture every second, at (n, 0, 0); each is published twice.
class Clicker final : public Sensor {
 public:
  explicit Clicker(std::string name) : name_(std::move(name)) {}
  void connect(Ports& ports) override { shots_ = ports.write<CameraShot>(name_); }
  void step(Time now) override {
    if (now.ns % 500'000'000 != 0) return;
    CameraShot shot;
    shot.index = count_++ / 2;
    shot.X_WS.p = {static_cast<double>(shot.index), 0, 0};
    shots_.write(now, shot);
  }

 private:
  std::string name_;
  int count_ = 0;
  SignalWriter<CameraShot> shots_;
};

/// Takes `pictures`, gives a map with as many rows; fails where `fails` says so.
class RowCounter final : public Job {
 public:
  explicit RowCounter(const ParameterSet& parameters) : fails_(parameters.boolean("fails")) {}
  Result<JobOutcome> run(const std::map<std::string, Product>& inputs) override {
    if (fails_) return Failure{"the pictures are too dark"};
    auto map = std::make_shared<RowMap>();
    map->rows.resize(inputs.at("pictures").pictures->X_WS.size());
    JobOutcome outcome;
    outcome.product.kind = ProductKind::kMap;
    outcome.numbers["rows"] = static_cast<double>(map->rows.size());
    outcome.product.map = map;
    return outcome;
  }

 private:
  bool fails_;
};

/// Finishes `work_s` after its first tick and publishes how many rows its map has.
class Worker final : public Controller {
 public:
  Worker(const ParameterSet& parameters, const ControllerContext& context)
      : work_s_(parameters.number("work_s")),
        rows_(static_cast<double>(context.map->rows.size())) {}
  void connect(Ports& ports) override {
    estimate_ = ports.read<Odometry>("estimate");
    actuators_ = ports.write<NamedValues>("actuators");
    rows_out_ = ports.write<NamedValues>("map_rows");
  }
  bool finished() const override { return finished_; }
  void step(Time now) override {
    if (!began_) begin_ = now;
    began_ = true;
    finished_ = (now - begin_).s() >= work_s_;
    rows_out_.write(now, {{"rows"}, {rows_}});
  }

 private:
  double work_s_, rows_;
  bool began_ = false, finished_ = false;
  Time begin_;
  SignalReader<Odometry> estimate_;
  SignalWriter<NamedValues> actuators_, rows_out_;
};

inline Registry mission_registry() {
  Registry registry = small_registry();
  PartSpec camera;
  camera.name = "clicker";
  camera.description = "for tests";
  camera.parameters = survey_camera_parameters();
  camera.gives = ProductKind::kPictures;
  camera.default_rate_Hz = 20.0;
  registry.add_sensor(camera, [](const ParameterSet&, const SensorContext& context) {
    return std::make_unique<Clicker>(context.name);
  });
  PartSpec job;
  job.name = "count_rows";
  job.description = "for tests";
  job.parameters = {boolean_parameter("fails", false, "whether it fails")};
  job.takes = {{"pictures", ProductKind::kPictures, true, "to count"}};
  job.gives = ProductKind::kMap;
  registry.add_job(job, [](const ParameterSet& parameters, const JobContext&) {
    return std::make_unique<RowCounter>(parameters);
  });
  PartSpec worker;
  worker.name = "worker";
  worker.description = "for tests";
  worker.parameters = {number_parameter("work_s", "s", 1.0, 0.0, 1e3, "until it has finished")};
  worker.default_rate_Hz = 20.0;
  registry.add_controller(worker,
                          [](const ParameterSet& parameters, const ControllerContext& context) {
                            return std::make_unique<Worker>(parameters, context);
                          });
  return registry;
}

}  // namespace vinerow::test
