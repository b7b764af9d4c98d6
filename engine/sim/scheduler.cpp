#include "engine/sim/scheduler.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/profile.h"

namespace vinerow {
namespace {

std::string in_seconds(Duration d) {
  return fmt::format("{:.9g} s", d.s());
}

}  // namespace

const char* to_string(Stage stage) {
  switch (stage) {
    case Stage::kSense:
      return "sense";
    case Stage::kEstimate:
      return "estimate";
    case Stage::kPlan:
      return "plan";
    case Stage::kGuide:
      return "guide";
    case Stage::kControl:
      return "control";
    case Stage::kActuate:
      return "actuate";
    case Stage::kPayload:
      return "payload";
    case Stage::kJudge:
      return "judge";
  }
  return "?";
}

int Scheduler::add(Stage stage, std::string name, Duration period, Duration offset,
                   std::function<void(Time)> run, Time begin) {
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
  const Time first = begin + offset;
  tasks_.insert(place, Task{++last_id_, stage, std::move(name), period, first, std::move(run)});
  earliest_ = std::min(earliest_, first);
  return last_id_;
}

void Scheduler::remove(int task) {
  const auto found =
      std::find_if(tasks_.begin(), tasks_.end(), [&](const Task& t) { return t.id == task; });
  if (found == tasks_.end()) return;
  removed_.push_back(report_of(*found));
  tasks_.erase(found);
}

void Scheduler::run_due(Time now) {
  if (now < earliest_) return;
  Time earliest{std::numeric_limits<std::int64_t>::max()};
  // Reading the clock costs as much as a short task: the end of one is the start of the next.
  std::optional<std::int64_t> start_ns;
  std::int64_t sum_ns = 0, longest_ns = 0;
  for (Task& task : tasks_) {
    if (task.next == now) {
      const ProfileSpan span(task.name, to_string(task.stage));
      if (measure_) {
        if (!start_ns) start_ns = clock_();
        task.run(now);
        const std::int64_t end_ns = clock_();
        const std::int64_t length_ns = end_ns - *start_ns;
        task.wall_ns += length_ns;
        sum_ns += length_ns;
        longest_ns = std::max(longest_ns, length_ns);
        start_ns = end_ns;
      } else {
        task.run(now);
      }
      ++task.ticks;
      task.next = now + task.period;
    }
    earliest = std::min(earliest, task.next);
  }
  earliest_ = earliest;
  two_cores_save_ns_ += std::min(sum_ns - longest_ns, sum_ns / 2);
}

Scheduler::TaskReport Scheduler::report_of(const Task& task) {
  return {task.name, task.stage, task.period, task.ticks, static_cast<double>(task.wall_ns) * 1e-9};
}

std::vector<Scheduler::TaskReport> Scheduler::reports() const {
  std::vector<TaskReport> result = removed_;
  for (const Task& task : tasks_) result.push_back(report_of(task));
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return a.stage < b.stage; });
  return result;
}

}  // namespace vinerow
