#pragma once
/// Multi-rate scheduler on integer nanoseconds.
///
/// Rates are exact: a task of period T and offset D runs at D, D + T, D + 2T ... and at no other
/// time. An hour has exactly 18,000 ticks of a 5 Hz task. Within an instant, tasks run in order of
/// stage, then in the order in which they were added.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/time.h"

namespace vinerow {

/// Order within one instant. Physics then advances the state to the next instant.
enum class Stage { kSense, kEstimate, kPlan, kGuide, kControl, kActuate, kPayload, kJudge };
const char* to_string(Stage stage);  ///< "sense"

class Scheduler {
 public:
  /// @param step  physics step; every period and offset must be a multiple of it
  explicit Scheduler(Duration step) : step_(step) {}

  /// @param name  for errors and timings, e.g. "rover.controller"
  /// @param begin  the task first runs at begin + offset, which must not be before the present
  ///   instant
  /// @returns handle for remove()
  /// @throws ConfigError with both numbers if the step does not divide the period or the offset
  int add(Stage stage, std::string name, Duration period, Duration offset,
          std::function<void(Time)> run, Time begin = {});
  /// Removes a task; its ticks so far stay in reports(). Must not be called while tasks run.
  void remove(int task);

  /// Runs all tasks that are due at `now`. Instants must be visited in ascending order, without
  /// gaps.
  void run_due(Time now);

  struct TaskReport {
    std::string name;
    Stage stage;
    Duration period;
    std::uint64_t ticks = 0;
    double wall_s = 0.0;  ///< computing time of all ticks; 0 if not measured
  };
  std::vector<TaskReport> reports() const;
  /// Bound of what tasks of one instant side by side could save on two cores, if none waited for
  /// another: in each instant the longest task, or half of the sum, is left. 0 if not measured.
  double two_cores_save_s() const { return static_cast<double>(two_cores_save_ns_) * 1e-9; }
  /// Wall time since an arbitrary moment, ns. A run never reads the time itself. The program that
  /// steps it may provide a clock, which influences no result.
  using Clock = std::int64_t (*)();
  /// @param measure  measures the computing time of each task too, not only of jobs
  void set_clock(Clock wall_ns, bool measure) {
    clock_ = wall_ns;
    measure_ = measure && wall_ns;
  }
  Clock clock() const { return clock_; }  ///< null: none

 private:
  struct Task {
    int id;
    Stage stage;
    std::string name;
    Duration period;
    Time next;
    std::function<void(Time)> run;
    std::uint64_t ticks = 0;
    std::int64_t wall_ns = 0;
  };
  Duration step_;
  static TaskReport report_of(const Task& task);

  std::vector<Task> tasks_;  // sorted by stage, stable
  std::vector<TaskReport> removed_;
  int last_id_ = 0;
  Time earliest_{0};
  Clock clock_ = nullptr;
  bool measure_ = false;
  std::int64_t two_cores_save_ns_ = 0;
};

}  // namespace vinerow
