/// Exchange with an autopilot on loopback: state out, outputs in, without the autopilot's own time.
/// The other side answers at once. Aim: 60 us of wall time.

#include <benchmark/benchmark.h>

#include <atomic>
#include <optional>
#include <thread>

#include "controllers/autopilot/ardupilot/lockstep_link.h"
#include "controllers/autopilot/ardupilot/state_line.h"
#include "controllers/autopilot/px4/hil_lockstep.h"
#include "tests/controllers/autopilot/fake_px4.h"

namespace vinerow::autopilot_bench {
namespace {

using namespace controllers;
using std::chrono::milliseconds;

constexpr mavlink::UdpAddress kAnyPort{0x7F000001, 0};

/// Sends packet n + 1 for each answer.
class Responder {
 public:
  explicit Responder(mavlink::UdpAddress peer) : socket_(kAnyPort, "responder"), peer_(peer) {
    thread_ = std::thread([this] {
      send();
      while (!stops_) {
        if (socket_.receive(milliseconds(20))) send();
      }
    });
  }
  ~Responder() {
    stops_ = true;
    thread_.join();
  }

 private:
  void send() {
    std::array<std::uint8_t, 40> packet{0x1A, 0x48, 0xB0, 0x04};
    for (int i = 0; i < 4; ++i) packet[4 + i] = static_cast<std::uint8_t>(frame_ >> (8 * i));
    ++frame_;
    socket_.send(packet, peer_);
  }

  mavlink::UdpSocket socket_;
  mavlink::UdpAddress peer_;
  std::uint32_t frame_ = 0;
  std::atomic<bool> stops_{false};
  std::thread thread_;
};

void exchange(benchmark::State& state) {
  LockstepLink link(kAnyPort, "bench");
  Responder responder({kAnyPort.host, link.port()});
  const auto never = [] { return std::string(); };
  if (!link.wait_for_first(milliseconds(5000), never)) return state.SkipWithError("no packet");
  StateLine line;
  ArdupilotState of_vehicle;
  for (auto _ : state) {
    of_vehicle.timestamp_s += 0.001;
    link.answer(line.write(of_vehicle));
    const auto packet = link.wait_for_next(milliseconds(5000), never);
    if (!packet) return state.SkipWithError(packet.reason().c_str());
  }
}
BENCHMARK(exchange)->Name("autopilot_exchange")->Unit(benchmark::kMicrosecond)->UseRealTime();

/// Answers each HIL_SENSOR at once.
class HilResponder {
 public:
  explicit HilResponder(std::uint16_t port) {
    options_.port = port;
    options_.silent = 0;
    fake_.emplace(options_, [](const FakePx4State&) { return FakePx4::Shares{}; });
  }

 private:
  FakePx4Options options_;
  std::optional<FakePx4> fake_;
};

void exchange_hil(benchmark::State& state) {
  RunningLockstepOptions options;
  options.own = {kAnyPort.host, mavlink::TcpServer(kAnyPort, "bench").port()};
  HilLockstep lockstep(options, "bench");
  HilResponder responder(options.own.port);
  mavlink::FrameWriter writer(mavlink::Sender{1, 200});
  std::uint64_t stamp_us = 0;
  const auto next_state = [&](std::uint64_t) {
    mavlink::HilSensor sensors;
    sensors.time_usec = stamp_us += 4000;
    sensors.xacc = static_cast<float>(stamp_us);
    return FirmwareState{writer.write(sensors), stamp_us};
  };
  if (!lockstep.begin(Time{}, next_state)) return state.SkipWithError("no outputs");
  for (auto _ : state) {
    lockstep.send_state(Time{}, next_state(0));
    const auto outputs = lockstep.wait_for_outputs(Time{});
    if (!outputs) return state.SkipWithError(outputs.reason().c_str());
  }
}
BENCHMARK(exchange_hil)
    ->Name("autopilot_exchange_hil")
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();

void write_line(benchmark::State& state) {
  StateLine line;
  ArdupilotState of_vehicle;
  of_vehicle.position_NED_m = {12.3456789, -98.7654321, -1.5};
  for (auto _ : state) {
    of_vehicle.timestamp_s += 0.001;
    benchmark::DoNotOptimize(line.write(of_vehicle).data());
  }
}
BENCHMARK(write_line)->Name("autopilot_state_line")->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace vinerow::autopilot_bench
