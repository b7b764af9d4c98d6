/// What payloads cost in Parcel F's vineyard: a tick of each between two rows, and the division of
/// the canopy into patches, once per payload.

#include <benchmark/benchmark.h>

#include "engine/api/map.h"
#include "engine/physics/physics_world.h"
#include "tests/benchmarks/bench_worlds.h"
#include "vehicles/payloads/canopy_patches.h"

namespace vinerow::payload_bench {
namespace {

struct Vineyard {
  std::unique_ptr<WorldModel> model = [] {
    auto made = bench::make_world("vineyard");
    made->wind.mean_speed_mps = 3.0;
    made->wind.turbulence = 1.0;
    made->wind.shelter_attenuation = 1.2;
    return made;
  }();
  physics::PhysicsWorld world{{}, *model};
};

const Vineyard& vineyard() {
  static const Vineyard instance;
  return instance;
}

/// A payload of a vehicle that drives up and down an alley at 1 m/s. Counter: work per simulated
/// second.
void payload_tick(benchmark::State& state, const char* type, double height_m) {
  const Vineyard& v = vineyard();
  Registry registry;
  register_all(registry);
  const PartSpec& spec = registry.spec(PartKind::kPayload, type);
  VehicleDescription description;
  description.height_above_ground_m = height_m;
  PayloadContext context;
  context.vehicle = "rover";
  context.part = "rover.p";
  context.name = "p";
  context.period = period_of_rate(spec.default_rate_Hz);
  context.scene = &v.world.scene();
  context.world = v.model.get();
  context.vehicle_description = &description;
  context.map = &*v.model->rows;
  ParameterSet parameters(spec.parameters, type);
  // The tank lasts.
  if (spec.name == "sprayer") parameters.set("tank_l", 1e9);
  const auto payload = registry.make_payload(type, parameters, context);
  SignalBus bus;
  auto truth = bus.advertise<Odometry>("rover/truth", "rover");
  auto estimate = bus.advertise<Odometry>("rover/estimate", "rover");
  Ports ports(bus, "rover", "rover.p");
  payload->connect(ports);

  const auto& line = v.model->rows->alleys[7].line_W;
  const Eigen::Vector3d displacement = line.back() - line.front();
  const double length_m = displacement.head<2>().norm();
  Odometry odometry;
  Time now;
  double s_m = 0.0, speed_mps = 1.0;
  for (auto _ : state) {
    s_m += speed_mps * context.period.s();
    if (s_m <= 0.0 || s_m >= length_m) speed_mps = -speed_mps;
    odometry.X_WB.p = line.front() + s_m / length_m * displacement;
    odometry.X_WB.p.z() =
        v.model->terrain->height_m(odometry.X_WB.p.x(), odometry.X_WB.p.y()) + height_m;
    odometry.X_WB.q =
        quaternion_from_rpy({0.0, 0.0, std::atan2(displacement.y(), displacement.x())});
    odometry.v_WB_B = {speed_mps, 0.0, 0.0};
    truth.write(now, odometry);
    estimate.write(now, odometry);
    payload->step(now);
    now = now + context.period;
  }
  for (const auto& [name, value] : payload->results()) {
    if (name.find("share") != std::string::npos) state.counters[name] = value;
  }
  state.counters["per_simulated_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * context.period.s(),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(payload_tick, sprayer, "sprayer", 0.42)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(payload_tick, canopy_camera, "canopy_camera", 1.5)->Unit(benchmark::kMicrosecond);

void canopy_patches_of_parcel_f(benchmark::State& state) {
  const Vineyard& v = vineyard();
  std::size_t count = 0;
  for (auto _ : state) {
    const vehicles::CanopyPatches patches(*v.model, 0.25, 0.25);
    count = patches.patches().size();
  }
  state.counters["patches"] = static_cast<double>(count);
}
BENCHMARK(canopy_patches_of_parcel_f)->Unit(benchmark::kMillisecond);

void canopy_patch_lookup(benchmark::State& state) {
  const Vineyard& v = vineyard();
  const vehicles::CanopyPatches patches(*v.model, 0.25, 0.25);
  std::size_t i = 0;
  std::array<vehicles::PatchShare, 4> shares;
  for (auto _ : state) {
    i = (i + 7919) % patches.patches().size();
    benchmark::DoNotOptimize(patches.spread(patches.patches()[i].p_W, shares));
  }
}
BENCHMARK(canopy_patch_lookup)->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace vinerow::payload_bench
