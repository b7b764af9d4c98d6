/// Log throughput.

#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>

#include "engine/api/messages/motion.h"
#include "engine/api/messages/sensors.h"
#include "engine/core/random.h"
#include "engine/record/recorder.h"

namespace vinerow::recorder_bench {
namespace {

void record_odometry_and_imu(benchmark::State& state) {
  const char* const compressions[] = {"none", "lz4", "zstd"};
  record::RecorderOptions options;
  options.compression = compressions[state.range(0)];
  const auto file = std::filesystem::temp_directory_path() / "vinerow_bench.mcap";
  SignalBus bus;
  auto truth = bus.advertise<Odometry>("rover/truth", "rover");
  auto imu = bus.advertise<ImuSample>("rover/imu", "rover");
  RandomStream random(1, "", "bench");
  double bytes = 0.0, messages = 0.0;
  {
    record::Recorder recorder(file, options, {});
    for (const auto& signal : bus.signals()) recorder.channels().add_signal(*signal, {});
    Odometry pose;
    ImuSample sample;
    Time now;
    for (auto _ : state) {
      pose.X_WB.p += Eigen::Vector3d(0.01, 0.002 * random.normal(), 0.001 * random.normal());
      sample.f_WS_S = {random.normal(), random.normal(), 9.8 + random.normal()};
      truth.write(now, pose);
      imu.write(now, sample);
      recorder.record(now);
      now = now + Duration{1'000'000};
    }
    messages = static_cast<double>(recorder.message_count());
    recorder.finish();
    bytes = static_cast<double>(recorder.bytes_written());
  }
  state.SetLabel(options.compression);
  state.counters["file_MB_per_s"] = benchmark::Counter(bytes * 1e-6, benchmark::Counter::kIsRate);
  state.counters["messages_per_s"] = benchmark::Counter(messages, benchmark::Counter::kIsRate);
  state.counters["bytes_per_message"] = messages > 0.0 ? bytes / messages : 0.0;
  std::filesystem::remove(file);
}
BENCHMARK(record_odometry_and_imu)->DenseRange(0, 2)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace vinerow::recorder_bench
