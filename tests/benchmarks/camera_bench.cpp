/// Pictures of a camera sensor in a vineyard whose leaves are there one by one, with four rows in
/// view. Pictures are cast on all cores: CPU is the time of all of them together, in ms a picture.

#include <benchmark/benchmark.h>

#include "engine/api/registry.h"
#include "engine/physics/static_scene.h"
#include "tests/benchmarks/bench_worlds.h"
#include "tools/parts/register_all.h"

namespace vinerow::camera_bench {
namespace {

struct Vineyard {
  std::shared_ptr<const WorldModel> model = bench::vineyard_in_leaf();
  physics::StaticScene scene{model};
};

const Vineyard& vineyard() {
  static const Vineyard instance;
  return instance;
}

/// 640 x 480 pixels from 1 m above the middle of an alley, along it.
void camera_frame(benchmark::State& state, const char* picture, bool shadows, bool labels) {
  const Vineyard& v = vineyard();
  Registry registry;
  register_all(registry);
  ParameterSet parameters(registry.spec(PartKind::kSensor, "camera").parameters, "camera");
  parameters.set("picture", std::string(picture)).set("shadows", shadows);
  for (const char* layer : {"depth", "semantic", "instance"}) parameters.set(layer, labels);
  SensorContext context;
  context.vehicle = "rover";
  context.part = "rover.sensors.camera";
  context.name = "camera";
  context.period = period_of_rate(10.0);
  context.scene = &v.scene.queries();
  context.light = [&]() -> const RayScene& { return v.scene.light(); };
  context.world = v.model.get();
  const auto sensor = registry.make_sensor("camera", parameters, context);
  SignalBus bus;
  SignalWriter<Odometry> truth = bus.advertise<Odometry>("rover/truth", "rover");
  Ports ports(bus, "rover", context.part);
  sensor->connect(ports);
  Odometry odometry;
  odometry.X_WB = bench::place_in_alley(*v.model);
  truth.write(Time{0}, odometry);
  std::int64_t tick = 0;
  for (auto _ : state) sensor->step(Time{100'000'000 * tick++});
  state.counters["frames_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(camera_frame, depth_and_labels, "depth", false, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(camera_frame, colour_without_shadows, "colour", false, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(camera_frame, colour, "colour", true, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace vinerow::camera_bench
