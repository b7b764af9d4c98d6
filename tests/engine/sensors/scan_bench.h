#pragma once
/// A sensor that is sampled within its period, on a vehicle that moves.

#include <functional>
#include <memory>
#include <string>

#include "tests/engine/sensors/data_sheet.h"
#include "tests/engine/sensors/sensor_bench.h"

namespace vinerow::test {

template <class T>
class ScanBench {
 public:
  using Way = std::function<Pose(double time_s)>;

  using Vehicles = std::function<VehicleScene&()>;

  ScanBench(const scenario::PartConfig& part, const SceneQuery& scene, std::uint64_t seed = 1)
      : ScanBench(part.type, part.parameters, scene, part.rate_Hz, seed) {}
  ScanBench(const std::string& type, const ParameterSet& parameters, const SceneQuery& scene,
            double rate_Hz = 10.0, std::uint64_t seed = 1, Vehicles vehicles = {},
            const WorldModel* world = nullptr) {
    SensorContext context = bench_.context(rate_Hz, seed);
    if (world != nullptr) context.world = world;
    context.scene = &scene;
    context.light = [&scene]() -> const RayScene& { return scene; };
    context.vehicles = std::move(vehicles);
    context.physics_step = duration_from_s(0.001);
    period_ = context.period;
    sensor_ = sensor_registry().make_sensor(type, parameters, context);
    bench_.connect(*sensor_);
    reading_ = bench_.bus.template subscribe<T>("rover/s", "test");
    truth_ = bench_.bus.template subscribe<T>("rover/s_truth", "test");
    advance();  // time 0
  }

  /// From now on. @param way  pose of the vehicle by time
  void move(Way way) { way_ = std::move(way); }

  /// One period, with its samples. @returns the reading at its end
  const T& step() {
    for (int i = 0; i < period_.ns / sensor_->sampling().ns; ++i) advance();
    return reading_.value();
  }
  const T& truth() const { return truth_.value(); }
  const SignalReader<T>& reading() const { return reading_; }
  Duration sampling() const { return sensor_->sampling(); }
  Time last() const { return now_ - sensor_->sampling(); }

 private:
  void advance() {
    Odometry odometry;
    odometry.X_WB = way_(now_.s());
    bench_.truth.write(now_, odometry);
    sensor_->sample(now_);
    if (now_.ns % period_.ns == 0) sensor_->step(now_);
    now_ = now_ + sensor_->sampling();
  }

  SensorBench bench_;
  Duration period_;
  std::unique_ptr<Sensor> sensor_;
  SignalReader<T> reading_, truth_;
  Way way_ = [](double) { return Pose{}; };
  Time now_{0};
};

}  // namespace vinerow::test
