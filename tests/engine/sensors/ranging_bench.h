#pragma once
/// A ranging sensor on a bench: parameters by name or from a device's file, any scene, one pose.

#include <memory>
#include <string>

#include "tests/engine/sensors/data_sheet.h"
#include "tests/engine/sensors/sensor_bench.h"

namespace vinerow::test {

/// Reads T ("s") and its truth ("s_truth") of a sensor whose vehicle stands where `truth` says.
template <class T>
class RangingBench {
 public:
  RangingBench(const std::string& type, const SensorValues& values, const SceneQuery& scene,
               double rate_Hz = 20.0, std::uint64_t seed = 1)
      : RangingBench(type, sensor_parameters(type, values), scene, rate_Hz, seed) {}
  RangingBench(const scenario::PartConfig& part, const SceneQuery& scene, std::uint64_t seed = 1)
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
  /// Before the first step: ticks fall beside the multiples of the period.
  void start_at(Time first) { now_ = first; }
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

}  // namespace vinerow::test
