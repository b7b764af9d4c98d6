#pragma once
/// A ranging sensor on a bench: parameters by name or from a device's file, any scene, one pose.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/io/scenario.h"
#include "engine/sensors/register.h"
#include "tests/engine/sensors/fixed_scene.h"
#include "tests/engine/sim/small_parts.h"
#include "tests/support/paths.h"

namespace vinerow::test {

inline const Registry& sensor_registry() {
  static const Registry registry = [] {
    Registry r;
    register_sensors(r);
    PartSpec world;
    world.name = "plain";
    world.parameters = {boolean_parameter("has_map", false, "an occupancy grid")};
    r.add_world(world, make_plain);
    PartSpec vehicle;
    vehicle.name = "statue";
    r.add_vehicle(vehicle, [](const ParameterSet&, const VehicleContext&) {
      return std::unique_ptr<Vehicle>(std::make_unique<Statue>());
    });
    return r;
  }();
  return registry;
}

using SensorValues = std::vector<std::pair<std::string, ParameterSet::Value>>;

inline ParameterSet sensor_parameters(const std::string& type, const SensorValues& values) {
  ParameterSet parameters(sensor_registry().spec(PartKind::kSensor, type).parameters, type);
  for (const auto& [name, value] : values) parameters.set(name, value);
  return parameters;
}

/// A sensor as a scenario gets it that includes assets/sensors/<device>.yaml.
inline io::PartConfig device(const std::string& name, const SensorValues& values = {}) {
  const std::string folder = std::string(VINEROW_SOURCE_DIR) + "/assets/sensors";
  io::Scenario scenario = io::parse_scenario(
      "vinerow: 1\nname: bench\nduration_s: 1\nworld: {type: plain}\nvehicles:\n  rover:\n"
      "    type: statue\n    spawn: {x_m: 0, y_m: 0}\n    sensors:\n      s: {include: " +
          name + ".yaml}\n",
      folder, sensor_registry());
  io::PartConfig part = scenario.vehicles.at(0).sensors.at(0).part;
  for (const auto& [parameter, value] : values) part.parameters.set(parameter, value);
  return part;
}

/// Reads T ("s") and its truth ("s_truth") of a sensor whose vehicle stands where `truth` says.
template <class T>
class RangingBench {
 public:
  RangingBench(const std::string& type, const SensorValues& values, const SceneQuery& scene,
               double rate_Hz = 20.0, std::uint64_t seed = 1)
      : RangingBench(type, sensor_parameters(type, values), scene, rate_Hz, seed) {}
  RangingBench(const io::PartConfig& part, const SceneQuery& scene, std::uint64_t seed = 1)
      : RangingBench(part.type, part.parameters, scene, part.rate_Hz, seed) {}
  RangingBench(const std::string& type, const ParameterSet& parameters, const SceneQuery& scene,
               double rate_Hz, std::uint64_t seed) {
    SensorContext context = bench_.context(rate_Hz, seed);
    context.scene = &scene;
    period_ = context.period;
    sensor_ = sensor_registry().make_sensor(type, parameters, context);
    bench_.connect(*sensor_);
    reading_ = bench_.bus.template subscribe<T>("rover/s", "test");
    truth_ = bench_.bus.template subscribe<T>("rover/s_truth", "test");
    place({});
  }

  void place(const Pose& X_WB) {
    Odometry odometry;
    odometry.X_WB = X_WB;
    bench_.truth.write(now_, odometry);
  }
  /// One tick. @returns the reading, that of an earlier tick if this one gave none
  const T& step() {
    sensor_->step(now_);
    now_ = now_ + period_;
    return reading_.value();
  }
  void step_only() {
    sensor_->step(now_);
    now_ = now_ + period_;
  }
  Time now() const { return now_; }
  Sensor& sensor() { return *sensor_; }
  const SignalReader<T>& reading() const { return reading_; }
  const SignalReader<T>& truth() const { return truth_; }
  SensorBench& bench() { return bench_; }

 private:
  SensorBench bench_;
  Duration period_;
  std::unique_ptr<Sensor> sensor_;
  SignalReader<T> reading_, truth_;
  Time now_{0};
};

/// What a maker refuses.
template <class F>
std::string refusal_of(F&& f) {
  try {
    f();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace vinerow::test
