#pragma once
/// A run with peers in a test: a rover that takes velocity commands, and the thread that runs it.

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include "engine/api/messages/commands.h"
#include "engine/api/outside.h"
#include "engine/live/live_run.h"
#include "engine/run/run.h"
#include "engine/scenario/scenario.h"
#include "tools/parts/register_all.h"

namespace vinerow::test {

inline const char* kRemoteRover = R"(
vinerow: 1
name: remote_rover
duration_s: 2
world: {type: vineyard, row_count: 2, row_length_m: 20, relief_m: 0, waves_m: 0, leaf_cards_per_m: 10, plant_variants: 1}
vehicles:
  rover:
    type: diff_drive_rover
    spawn: {alley: 0}
    sensors: {imu: {type: imu, rate_Hz: 100}}
    controller: {type: remote_velocity, timeout_s: 0.3}
)";

inline const char* kLockstep = "lockstep: {topic: rover/cmd_vel, rate_Hz: 20, timeout_s: 5}\n";

inline const Registry& all_parts() {
  static const Registry registry = [] {
    Registry parts;
    register_all(parts);
    return parts;
  }();
  return registry;
}

inline scenario::Scenario remote_rover(const std::string& more = "") {
  return scenario::parse_scenario(kRemoteRover + more, ".", all_parts());
}

/// Runs without files. @param driver  may be null
inline run::RunResult run_alone(const scenario::Scenario& scenario,
                                std::shared_ptr<run::RunDriver> driver = nullptr) {
  run::RunOptions options;
  options.pictures = false;
  options.driver = std::move(driver);
  return run::run_scenario(scenario, all_parts(), options);
}

/// A velocity command of a peer.
inline live::PeerCommand velocity(const std::string& peer, Time stamp, double v_mps,
                                  double yaw_rate_radps = 0.0) {
  return {outside_command("rover/cmd_vel", stamp, VelocityCommand{v_mps, yaw_rate_radps}), peer};
}

/// Runs a scenario in a thread of its own, without files unless `out` is given.
class BackgroundRun {
 public:
  /// @param serve  makes a server of the run, before it begins
  BackgroundRun(scenario::Scenario scenario, live::ControlOptions control,
                std::filesystem::path out = {},
                const std::function<std::shared_ptr<void>(live::LiveRun&)>& serve = nullptr)
      : scenario_(std::move(scenario)),
        live(std::make_shared<live::LiveRun>(
            with_lockstep(std::move(control), scenario_),
            [this](live::RunControl::Level, const std::string& sentence) {
              const std::lock_guard lock(mutex_);
              said_ += sentence + "\n";
            })) {
    if (serve) server_ = serve(*live);
    result_ = std::async(std::launch::async, [this, out] {
      run::RunOptions options;
      options.out = out;
      options.pictures = false;
      options.driver = live;
      return run::run_scenario(scenario_, all_parts(), options);
    });
  }
  ~BackgroundRun() {
    live->control().stop("the test is over");
    if (result_.valid()) result_.wait();
    server_ = nullptr;
  }

  run::RunResult join() { return result_.get(); }
  std::string said() const {
    const std::lock_guard lock(mutex_);
    return said_;
  }
  live::RunControl& control() { return live->control(); }

  /// Waits until something is so; fails after 20 s.
  void await(const std::function<bool()>& condition) {
    for (int i = 0; i < 20'000; ++i) {
      if (condition()) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    FAIL() << "this did not come in 20 s";
  }
  void await_state(live::RunState state) {
    await([&] { return control().snapshot().state == state; });
  }

 private:
  static live::ControlOptions with_lockstep(live::ControlOptions control,
                                            const scenario::Scenario& scenario) {
    if (!scenario.lockstep.signal.empty()) control.lockstep = scenario.lockstep;
    return control;
  }

  scenario::Scenario scenario_;
  mutable std::mutex mutex_;
  std::string said_;

 public:
  std::shared_ptr<live::LiveRun> live;

 private:
  std::shared_ptr<void> server_;  ///< destroyed before `live`
  std::future<run::RunResult> result_;
};

/// Calls a request that answers later, and returns its answer.
inline std::string answer_of(const std::function<void(live::Answer)>& request) {
  auto answer = std::make_shared<std::promise<std::string>>();
  auto future = answer->get_future();
  request([answer](const std::string& reason) { answer->set_value(reason); });
  if (future.wait_for(std::chrono::seconds(20)) != std::future_status::ready) return "no answer";
  return future.get();
}

}  // namespace vinerow::test
