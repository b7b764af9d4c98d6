#pragma once
/// Multi-rate scheduler on integer nanoseconds: which tasks are due at an instant, and in which
/// order.
///
/// Rates are exact: a task of period T and offset D runs at D, D + T, D + 2T ... and at no other
/// time, so that an hour holds exactly 18,000 ticks of a 5 Hz task. Inside an instant tasks run by
/// stage, then in order of adding.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/time.h"

namespace vinerow {

/// The order inside one instant. Physics then carries the state to the next instant.
enum class Stage { kSense, kEstimate, kPlan, kGuide, kControl, kActuate, kPayload, kJudge };

class Scheduler {
 public:
  /// @param step  physics step; every period and offset must be a multiple of it
  explicit Scheduler(Duration step) : step_(step) {}

  /// @param name  who, for errors and timings, e.g. "rover.controller"
  /// @param begin  the task first runs at begin + offset; not before the instant worked on
  /// @returns what remove() takes
  /// @throws ConfigError naming both numbers if the step does not divide the period or the offset
  int add(Stage stage, std::string name, Duration period, Duration offset,
          std::function<void(Time)> run, Time begin = {});
  /// Its ticks so far stay in reports(). Not to be called while tasks run.
  void remove(int task);

  /// Runs everything that is due at `now`. Instants must be visited in rising order without gaps.
  void run_due(Time now);

  struct TaskReport {
    std::string name;
    Stage stage;
    Duration period;
    std::uint64_t ticks = 0;
    double wall_s = 0.0;  ///< computing time of all ticks; 0 where it was not measured
  };
  std::vector<TaskReport> reports() const;
  /// Tells how much wall time has passed since some moment, ns. A run never asks the time itself:
  /// whoever steps it may give it a clock, which never reaches a result.
  using Clock = std::int64_t (*)();
  /// @param measure  the computing time of each task too, and not only of jobs
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
};

}  // namespace vinerow
