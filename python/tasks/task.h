#pragma once
/// Task of a learning agent: what one vehicle of a session observes, does and is rewarded for.
///
/// A task takes over one signal of its vehicle, writes it from an action, and reads the vehicle's
/// sensors. Its reward may use the truth, as the environments of other simulators do; its
/// observation never does. Guide: docs/guides/gym.md.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/api/outside.h"
#include "engine/api/parameters.h"
#include "engine/sim/session.h"

namespace vinerow::tasks {

/// One number of an observation or of an action.
struct Element {
  std::string name;  ///< ends with its unit: "range_left_front_m"
  float low = -1.0F;
  float high = 1.0F;
};

/// What a step was worth.
struct Judgement {
  double reward = 0.0;
  bool terminated = false;
  bool succeeded = false;  ///< terminated because the goal was reached
};

class Task {
 public:
  virtual ~Task() = default;

  virtual const std::vector<Element>& observation() const = 0;
  /// Every action is limited to its bounds, -1 to 1.
  virtual const std::vector<Element>& action() const = 0;
  /// Numbers for people, e.g. the mean deviation so far. @returns names with units
  virtual const std::vector<std::string>& numbers() const = 0;
  /// The signal that act() writes.
  virtual OutsideSignal taken_over() const = 0;

  /// Connects to a session that was just opened or reset, processes its first instant, and what has
  /// to happen before the agent takes over (take-off). @throws ConfigError if the session lacks a
  /// signal
  virtual void begin(Session& session) = 0;
  /// Writes the action at the session's next instant. @param action  finite, within its bounds
  virtual void act(Session& session, std::span<const float> action) = 0;
  /// Judges the period since the last call.
  virtual Judgement judge(Session& session) = 0;
  /// The present observation, within its bounds.
  virtual void observe(std::span<float> observation) = 0;
  /// The present numbers.
  virtual void measure(std::span<double> numbers) const = 0;
};

/// What every task is made from.
struct TaskContext {
  std::string vehicle;     ///< name in the scenario
  double period_s = 0.02;  ///< of the agent
};

/// Declaration of a task, for lists and documents.
struct TaskSpec {
  std::string name;         ///< "row_following"
  std::string description;  ///< one sentence
  std::vector<ParameterSpec> parameters;
};

/// All tasks.
const std::vector<TaskSpec>& task_specs();
/// @throws ConfigError on an unknown name
const TaskSpec& task_spec(const std::string& name);
/// @param parameters  checked against the spec's
std::unique_ptr<Task> make_task(const std::string& name, const ParameterSet& parameters,
                                const TaskContext& context);

}  // namespace vinerow::tasks
