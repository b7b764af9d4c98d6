/// Time of the net of the assets on one picture of 160 x 120 pixels, one core.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "engine/nets/segmentation_net.h"
#include "tests/support/paths.h"

namespace vinerow::net_bench {
namespace {

void net_picture(benchmark::State& state) {
  if (!nets::why_no_nets().empty()) {
    state.SkipWithError(nets::why_no_nets().c_str());
    return;
  }
  nets::SegmentationNet net(std::string(VINEROW_SOURCE_DIR) + "/assets/models/row_net.onnx");
  const int height = 120, width = 160;
  const std::vector<float> planes(std::size_t{3} * height * width, 0.5f);
  for (auto _ : state) benchmark::DoNotOptimize(net.run(planes, height, width).values.data());
}
BENCHMARK(net_picture)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vinerow::net_bench
