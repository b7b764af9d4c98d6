#pragma once
/// A sensor by its registered name with parameters as a test says or as a data sheet says.

#include <fmt/format.h>

#include "engine/io/scenario.h"
#include "engine/sensors/register.h"
#include "tests/engine/sensors/fixed_scene.h"
#include "tests/support/paths.h"

namespace vinerow::test {

using SensorValues = std::vector<std::pair<std::string, ParameterSet::Value>>;

inline ParameterSet sensor_parameters(const std::string& type, const SensorValues& values = {}) {
  Registry registry;
  register_sensors(registry);
  ParameterSet parameters(registry.spec(PartKind::kSensor, type).parameters, type);
  for (const auto& [name, value] : values) parameters.set(name, value);
  return parameters;
}

/// What a scenario reads from assets/sensors/<sheet>.yaml, through the scenario's own loader.
inline io::PartConfig data_sheet(const std::string& sheet) {
  Registry registry;
  register_sensors(registry);
  PartSpec world, cart;
  world.name = "flat";
  cart.name = "cart";
  registry.add_world(world, nullptr);
  registry.add_vehicle(cart, nullptr);
  const io::Scenario scenario = io::parse_scenario(
      fmt::format("vinerow: 1\nname: sheet\nduration_s: 1\nworld: {{type: flat}}\n"
                  "vehicles:\n  cart:\n    type: cart\n    spawn: {{x_m: 0, y_m: 0, yaw_deg: 0}}\n"
                  "    sensors: {{s: {{include: {}.yaml}}}}\n",
                  sheet),
      std::string(VINEROW_SOURCE_DIR) + "/assets/sensors", registry);
  return scenario.vehicles.at(0).sensors.at(0).part;
}

/// One sensor, and a truth that the test moves.
template <class Message>
class SensorRig {
 public:
  SensorRig(const std::string& type, const ParameterSet& parameters, double rate_Hz,
            std::uint64_t seed = 1, const GeoOrigin& origin = {}) {
    bench.world.origin = origin;
    Registry registry;
    register_sensors(registry);
    sensor = registry.make_sensor(type, parameters, bench.context(rate_Hz, seed));
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

/// A window for a sensor's `outages`.
inline ParameterSet with_outage(ParameterSet parameters, double begin_s, double end_s) {
  ParameterSet window = parameters.make_group("outages");
  window.set("begin_s", begin_s).set("end_s", end_s);
  parameters.set("outages", std::vector<ParameterSet>{window});
  return parameters;
}

}  // namespace vinerow::test
