/// Sensors in a run: how many readings an hour holds, and what of them is in the log.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "engine/api/messages/sensors.h"
#include "engine/record/log_reader.h"
#include "engine/run/run.h"
#include "engine/sensors/register_sensors.h"
#include "engine/sim/scheduler.h"
#include "tests/engine/record/raw_messages.h"
#include "tests/engine/sensors/sensor_bench.h"
#include "tests/engine/sim/small_parts.h"

namespace vinerow::run::sensor_run_test {
namespace {

/// Registered sensors at their default rates on a scheduler, without physics.
class SensorHour {
 public:
  void add(const std::string& type, const std::string& name,
           const std::vector<std::pair<std::string, double>>& values = {}) {
    Registry registry;
    sensors::register_sensors(registry);
    const PartSpec& spec = registry.spec(PartKind::kSensor, type);
    ParameterSet parameters(spec.parameters, type);
    for (const auto& [parameter, value] : values) parameters.set(parameter, value);
    SensorContext context = bench_.context(spec.default_rate_Hz);
    context.name = name;
    context.part = "rover.sensors." + name;
    sensors_.push_back(registry.make_sensor(type, parameters, context));
    Sensor* sensor = sensors_.back().get();
    Ports ports(bench_.bus, "rover", context.part);
    sensor->connect(ports);
    scheduler_.add(Stage::kSense, name, context.period, {},
                   [sensor](Time now) { sensor->step(now); });
    if (sensor->delay().ns == 0) return;
    scheduler_.add(Stage::kSense, name + ".delivery", context.period, sensor->delay(),
                   [sensor](Time now) { sensor->deliver(now); });
  }

  /// [0, 3600) s.
  void run() {
    bench_.truth.write(Time{0}, Odometry{});
    for (std::int64_t k = 0; k < 3'600'000'000'000 / kStep_ns; ++k) {
      scheduler_.run_due(Time{k * kStep_ns});
    }
  }
  std::uint64_t written(const std::string& signal) const {
    return bench_.bus.find("rover/" + signal)->sequence();
  }

 private:
  static constexpr std::int64_t kStep_ns = 5'000'000;
  test::SensorBench bench_;
  Scheduler scheduler_{Duration{kStep_ns}};
  std::vector<std::unique_ptr<Sensor>> sensors_;
};

TEST(SensorHour, HoldsExactlyTheReadingsOfEachRate) {
  SensorHour hour;
  hour.add("gps", "gps");
  hour.add("gps", "late_gps", {{"delay_s", 0.25}});
  hour.add("gps", "poor_gps", {{"dropout_share", 0.2}});
  hour.add("imu", "imu");
  for (const char* name : {"sonar_0", "sonar_1"}) hour.add("ultrasound", name);
  hour.run();
  EXPECT_EQ(hour.written("gps"), 18'000u);
  EXPECT_EQ(hour.written("imu"), 360'000u);
  EXPECT_EQ(hour.written("sonar_0"), 72'000u);
  EXPECT_EQ(hour.written("sonar_1"), 72'000u);
  for (const char* name : {"gps", "late_gps", "poor_gps"}) {
    EXPECT_EQ(hour.written(std::string(name) + "_truth"), 18'000u) << name;
  }
  // Those of 3599.8 s are still on their way.
  EXPECT_EQ(hour.written("late_gps"), 17'999u);
  // Five standard deviations.
  EXPECT_NEAR(static_cast<double>(hour.written("poor_gps")), 0.8 * 18'000,
              5.0 * std::sqrt(0.8 * 0.2 * 18'000));
}

TEST(SensorLog, HoldsLateAndLostFixesBesideTheirTruth) {
  Registry registry = test::small_registry();
  sensors::register_sensors(registry);
  const auto folder = std::filesystem::temp_directory_path() / "vinerow_sensor_log";
  std::filesystem::remove_all(folder);
  RunOptions options;
  options.out = folder;
  options.pictures = false;
  run_scenario(scenario::parse_scenario(R"(
vinerow: 1
name: sensor_log
duration_s: 20
world: {type: plain}
vehicles:
  rover:
    type: statue
    spawn: {x_m: 1, y_m: 2}
    sensors:
      gps: {type: gps, rate_Hz: 5, delay_s: 0.3, dropout_share: 0.4, position_m: [0.5, 0, 1]}
)",
                                        ".", registry),
               registry, options);
  const record::LogReader log(folder / "log.mcap");
  std::map<std::int64_t, GnssFix> truths;
  log.read<GnssFix>("/rover/gps_truth",
                    [&](Time stamp, const GnssFix& fix) { truths[stamp.ns] = fix; });
  ASSERT_EQ(truths.size(), 101u) << "0 to 20 s, every 0.2 s";
  int fixes = 0;
  log.read<GnssFix>("/rover/gps", [&](Time stamp, const GnssFix& fix) {
    ++fixes;
    ASSERT_TRUE(truths.contains(stamp.ns)) << stamp.s();
    const GnssFix& exact = truths[stamp.ns];
    EXPECT_EQ(exact.p_W.head<2>(), Eigen::Vector2d(1.5, 2.0));
    EXPECT_NE(fix.p_W, exact.p_W);
    EXPECT_LT((fix.p_W - exact.p_W).norm(), 0.2) << "far beyond its noise of 1 cm and 2 cm";
  });
  // Of 99 that were due by the end, five standard deviations about 60 %.
  EXPECT_NEAR(fixes, 59.4, 5.0 * std::sqrt(0.6 * 0.4 * 99));
  const auto file = folder / "log.mcap";
  test::read_raw(file, [&](Time logged, const record::ChannelInfo& channel, const auto&) {
    if (channel.topic == "/rover/gps") {
      EXPECT_EQ(logged.ns % 200'000'000, 100'000'000) << "0.3 s after the measurement";
    }
  });
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace vinerow::run::sensor_run_test
