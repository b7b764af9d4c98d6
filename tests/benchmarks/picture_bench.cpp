/// Time of a frame: the surveyed vineyard from the height of a walker, at two sizes, with two
/// and four samples a pixel.

#include <benchmark/benchmark.h>

#include "engine/api/map.h"
#include "engine/render/cameras.h"
#include "engine/render/scene.h"
#include "tests/benchmarks/bench_worlds.h"
#include "tests/support/paths.h"

namespace vinerow::picture_bench {
namespace {

void frame_of_riseholme(benchmark::State& state) {
  static const auto world = bench::make_world(
      "surveyed", {{"survey_file", std::string(VINEROW_SOURCE_DIR) +
                                       "/assets/worlds/riseholme/riseholme.geojson"}});
  static auto renderer = render::make_renderer(*world);
  if (!renderer) {
    state.SkipWithError(renderer.reason().c_str());
    return;
  }
  const Alley& alley = world->rows->alleys[4];
  const Eigen::Vector3d along = (alley.line_W.back() - alley.line_W.front()).normalized();
  render::Frame frame;
  frame.camera = render::look_at(alley.line_W.front() - 3.0 * along + Eigen::Vector3d(0, 0, 2.0),
                                 alley.line_W.back() + Eigen::Vector3d(0, 0, 0.5));
  frame.width = static_cast<int>(state.range(0));
  frame.height = static_cast<int>(state.range(1));
  frame.samples = static_cast<int>(state.range(2));
  for (auto _ : state) benchmark::DoNotOptimize((*renderer)->draw(frame).rgb.data());
}
BENCHMARK(frame_of_riseholme)
    ->ArgNames({"width", "height", "samples"})
    ->Args({640, 480, 2})
    ->Args({1280, 720, 2})
    ->Args({640, 480, 4})
    ->Args({1280, 720, 4})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vinerow::picture_bench
