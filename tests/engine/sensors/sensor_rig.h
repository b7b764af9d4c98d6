#pragma once
/// A sensor whose truth a test moves, and statistics of what it reads.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/engine/sensors/sensor_bench.h"
#include "tests/engine/sensors/sensor_parts.h"

namespace vinerow::test {

/// One sensor, and a truth that the test moves.
template <class Message>
class SensorRig {
 public:
  SensorRig(const std::string& type, const ParameterSet& parameters, double rate_Hz,
            std::uint64_t seed = 1, const GeoOrigin& origin = {}) {
    bench.world.origin = origin;
    sensor = sensor_registry().make_sensor(type, parameters, bench.context(rate_Hz, seed));
    bench.connect(*sensor);
    period_ns_ = period_of_rate(rate_Hz).ns;
    reading.emplace(bench.bus.template subscribe<Message>("rover/s", "test"));
    true_reading.emplace(bench.bus.template subscribe<Message>("rover/s_truth", "test"));
  }
  SensorRig(const std::string& type, const SensorValues& values, double rate_Hz,
            std::uint64_t seed = 1, const GeoOrigin& origin = {})
      : SensorRig(type, sensor_parameters(type, values), rate_Hz, seed, origin) {}

  const Message& read(const Odometry& truth = {}) {
    now = Time{period_ns_ * tick_++};
    bench.truth.write(now, truth);
    sensor->step(now);
    return reading->value();
  }

  SensorBench bench;
  std::unique_ptr<Sensor> sensor;
  std::optional<SignalReader<Message>> reading, true_reading;
  Time now;

 private:
  std::int64_t period_ns_ = 0;
  std::int64_t tick_ = 0;
};

/// Mean, variance and correlation with the sample before of a series as it comes.
class Moments {
 public:
  void add(double x) {
    ++count_;
    sum_ += x;
    squares_ += x * x;
    if (count_ > 1) lagged_ += x * last_;
    last_ = x;
  }
  double mean() const { return sum_ / static_cast<double>(count_); }
  /// About zero.
  double mean_square() const { return squares_ / static_cast<double>(count_); }
  double correlation() const { return lagged_ / squares_; }
  std::int64_t count() const { return count_; }

 private:
  std::int64_t count_ = 0;
  double sum_ = 0.0, squares_ = 0.0, lagged_ = 0.0, last_ = 0.0;
};

}  // namespace vinerow::test
