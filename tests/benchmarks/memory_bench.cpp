/// Resident memory of Parcel F: world, physics and rays, in a process of its own.

#include <benchmark/benchmark.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "engine/physics/physics_world.h"
#include "tests/benchmarks/bench_worlds.h"

namespace vinerow::memory_bench {
namespace {

double peak_resident_MB() {
  std::ifstream status("/proc/self/status");
  std::string key;
  while (status >> key) {
    if (key == "VmHWM:") {
      double kilobytes = 0.0;
      status >> kilobytes;
      return kilobytes * 1e-3;
    }
  }
  return -1.0;
}

struct Size {
  double resident_MB = 0.0;
  double triangles = 0.0;
};

/// Builds the world in a child, so that nothing else is counted.
Size measure_parcel_f() {
  int channel[2];
  if (pipe(channel) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    const auto model = bench::make_world("vineyard");
    const physics::PhysicsWorld world({}, *model);
    Size size;
    for (const MeshInstance& instance : model->meshes) {
      size.triangles += static_cast<double>(instance.mesh->triangles.size());
    }
    size.resident_MB = peak_resident_MB();
    _exit(write(channel[1], &size, sizeof size) == sizeof size ? 0 : 1);
  }
  Size size;
  const bool complete = read(channel[0], &size, sizeof size) == sizeof size;
  waitpid(child, nullptr, 0);
  close(channel[0]), close(channel[1]);
  return complete ? size : Size{};
}

void memory_of_parcel_f(benchmark::State& state) {
  Size size;
  for (auto _ : state) size = measure_parcel_f();
  state.counters["peak_MB"] = size.resident_MB;
  state.counters["instanced_triangles"] = size.triangles;
}
BENCHMARK(memory_of_parcel_f)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
}  // namespace vinerow::memory_bench
