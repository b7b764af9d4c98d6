/// Cost of peers for the run's thread: CPU time of a run of 20 s without files.

#include <benchmark/benchmark.h>

#include "engine/live/web_server.h"
#include "tests/engine/live/live_support.h"

namespace vinerow::live_bench {
namespace {

/// Takes everything, or has no room.
class Watcher final : public live::Subscriber {
 public:
  explicit Watcher(bool is_stalled) : is_stalled_(is_stalled) {}
  void receive(const live::Message& message) override {
    benchmark::DoNotOptimize(message.bytes->data());
  }
  bool has_room() const override { return !is_stalled_; }
  void miss() override { ++missed_; }

 private:
  bool is_stalled_;
  std::size_t missed_ = 0;
};

/// Subscribes to every channel when the run begins.
class Audience final : public live::RunListener {
 public:
  Audience(live::LiveRun& run, bool is_stalled) : run_(run), is_stalled_(is_stalled) {}
  void on_begin(Simulation&) override {
    const auto watcher = std::make_shared<Watcher>(is_stalled_);
    for (const live::Channel& channel : run_.hub()->channels()) {
      run_.hub()->subscribe(channel.id, watcher);
    }
  }

 private:
  live::LiveRun& run_;
  bool is_stalled_;
};

/// 0: no peers; 1: a server without clients; 2: a stalled client of all channels; 3: a quick one.
void live_run(benchmark::State& state) {
  std::string text = test::kRemoteRover;
  text.replace(text.find("duration_s: 2"), 13, "duration_s: 20");
  const scenario::Scenario scenario = scenario::parse_scenario(text, ".", test::all_parts());
  for (auto _ : state) {
    std::shared_ptr<live::LiveRun> run;
    std::unique_ptr<live::WebServer> server;
    std::unique_ptr<Audience> audience;
    if (state.range(0) > 0) {
      run = std::make_shared<live::LiveRun>(live::ControlOptions{.speed = 0.0}, nullptr);
      server = std::make_unique<live::WebServer>(
          *run, live::ServerOptions{.host = "127.0.0.1", .port = 0, .token = ""});
    }
    if (state.range(0) > 1) {
      audience = std::make_unique<Audience>(*run, state.range(0) == 2);
      run->add_listener(audience.get());
    }
    benchmark::DoNotOptimize(test::run_alone(scenario, run).digest);
  }
}
BENCHMARK(live_run)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->MinTime(3.0);

}  // namespace
}  // namespace vinerow::live_bench
