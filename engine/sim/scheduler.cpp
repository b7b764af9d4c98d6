#include "engine/sim/scheduler.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "engine/core/error.h"

namespace vinerow {
namespace {

std::string in_seconds(Duration d) {
  return fmt::format("{:.9g} s", d.s());
}

}  // namespace

void Scheduler::add(Stage stage, std::string name, Duration period, Duration offset,
                    std::function<void(Time)> run) {
  if (period.ns <= 0 || period.ns % step_.ns != 0) {
    throw ConfigError(
        fmt::format("{}: its period of {} is not a multiple of the physics step of {}", name,
                    in_seconds(period), in_seconds(step_)));
  }
  if (offset.ns < 0 || offset.ns % step_.ns != 0) {
    throw ConfigError(fmt::format("{}: its delay of {} is not a multiple of the physics step of {}",
                                  name, in_seconds(offset), in_seconds(step_)));
  }
  const auto place = std::upper_bound(tasks_.begin(), tasks_.end(), stage,
                                      [](Stage s, const Task& task) { return s < task.stage; });
  tasks_.insert(place, Task{stage, std::move(name), period, Time{offset.ns}, std::move(run)});
}

void Scheduler::run_due(Time now) {
  if (now < earliest_) return;
  Time earliest{std::numeric_limits<std::int64_t>::max()};
  for (Task& task : tasks_) {
    if (task.next == now) {
      if (measure_) {
        const auto start = std::chrono::steady_clock::now();
        task.run(now);
        task.wall_ns += std::chrono::duration_cast<std::chrono::nanoseconds>(
                            std::chrono::steady_clock::now() - start)
                            .count();
      } else {
        task.run(now);
      }
      ++task.ticks;
      task.next = now + task.period;
    }
    earliest = std::min(earliest, task.next);
  }
  earliest_ = earliest;
}

std::vector<Scheduler::TaskReport> Scheduler::reports() const {
  std::vector<TaskReport> result;
  for (const Task& task : tasks_) {
    result.push_back(
        {task.name, task.stage, task.period, task.ticks, static_cast<double>(task.wall_ns) * 1e-9});
  }
  return result;
}

}  // namespace vinerow
