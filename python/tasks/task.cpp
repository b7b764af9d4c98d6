#include "python/tasks/task.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "python/tasks/headland_turn.h"
#include "python/tasks/row_flight.h"
#include "python/tasks/row_following.h"

namespace vinerow::tasks {
namespace {

struct TaskEntry {
  TaskSpec spec;
  std::unique_ptr<Task> (*make)(const ParameterSet&, const TaskContext&);
};

const std::vector<TaskEntry>& entries() {
  static const std::vector<TaskEntry> all = {{headland_turn_spec(), &make_headland_turn},
                                             {row_flight_spec(), &make_row_flight},
                                             {row_following_spec(), &make_row_following},
                                             {spraying_spec(), &make_spraying}};
  return all;
}

const TaskEntry& entry(const std::string& name) {
  std::vector<std::string> known;
  for (const TaskEntry& entry : entries()) {
    if (entry.spec.name == name) return entry;
    known.push_back(entry.spec.name);
  }
  throw ConfigError(
      fmt::format("no task '{}'{} (known: {})", name, did_you_mean(name, known), join(known)));
}

}  // namespace

const std::vector<TaskSpec>& task_specs() {
  static const std::vector<TaskSpec> specs = [] {
    std::vector<TaskSpec> all;
    for (const TaskEntry& entry : entries()) all.push_back(entry.spec);
    return all;
  }();
  return specs;
}

const TaskSpec& task_spec(const std::string& name) {
  return entry(name).spec;
}

std::unique_ptr<Task> make_task(const std::string& name, const ParameterSet& parameters,
                                const TaskContext& context) {
  return entry(name).make(parameters, context);
}

}  // namespace vinerow::tasks
