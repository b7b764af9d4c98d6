#pragma once
/// A satellite receiver before any scene: blocks of canopy and posts, or a world.

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/api/messages/sensors.h"
#include "engine/math/angles.h"
#include "tests/engine/sensors/sensor_bench.h"
#include "tests/engine/sensors/sensor_parts.h"

namespace vinerow::test {

/// Rows along y, 2.5 m apart, 0.6 m wide and 0.5 m to 2 m high, with x = 0 in the middle of an
/// alley.
inline PlainScene vine_rows() {
  PlainScene scene;
  for (int row = -4; row <= 3; ++row) {
    const double x = 1.25 + 2.5 * row;
    scene.boxes.push_back({{x - 0.3, -200.0, 0.5}, {x + 0.3, 200.0, 2.0}});
  }
  return scene;
}

inline GeoOrigin barolo() {
  return {rad_from_deg(44.615), rad_from_deg(7.924), 300.0};
}

class GnssBench {
 public:
  static ParameterSet parameters(const SensorValues& values) {
    return sensor_parameters("gnss", values);
  }

  GnssBench(const SceneQuery& scene, const ParameterSet& parameters, std::uint64_t seed = 1,
            double rate_Hz = 5.0) {
    bench_.world.origin = barolo();
    SensorContext context = bench_.context(rate_Hz, seed);
    context.scene = &scene;
    period_ = context.period;
    sensor_ = sensor_registry().make_sensor("gnss", parameters, context);
    bench_.connect(*sensor_);
    fix_ = bench_.bus.subscribe<GnssFix>("rover/s", "test");
    exact_ = bench_.bus.subscribe<GnssFix>("rover/s_truth", "test");
    place({0, 0, 1});
  }

  void place(const Eigen::Vector3d& p_W, const Eigen::Vector3d& v_W = {0, 0, 0}) {
    truth_.X_WB.p = p_W;
    truth_.v_WB_B = v_W;
  }
  double time_s() const { return next_.s(); }  ///< of the next tick
  const GnssFix& step() {
    bench_.truth.write(next_, truth_);
    sensor_->step(next_);
    // A receiver with a delay below its period delivers its fix before the next tick.
    if (sensor_->delay().ns > 0) sensor_->deliver(next_ + sensor_->delay());
    next_ = next_ + period_;
    return fix_.value();
  }
  Eigen::Vector3d error() const { return fix_.value().p_W - exact_.value().p_W; }

 private:
  SensorBench bench_;
  Duration period_;
  std::unique_ptr<Sensor> sensor_;
  SignalReader<GnssFix> fix_, exact_;
  Odometry truth_;
  Time next_{0};
};

}  // namespace vinerow::test
