#pragma once
/// Many environments, stepped on several threads, with their numbers in contiguous arrays.
///
/// Environments share nothing that a step changes, so the bits of each do not depend on the number
/// of environments or threads.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "python/tasks/environment.h"
#include "python/tasks/workers.h"

namespace vinerow::tasks {

/// What happens after the last step of an episode (as in Gymnasium's AutoresetMode).
enum class Autoreset {
  kNextStep,  ///< the next step resets, ignores its action and has reward 0
  kSameStep,  ///< the step resets; the last observation and numbers are kept beside
  kDisabled   ///< the caller resets
};

/// Environments with one agent each.
class VectorEnvironment {
 public:
  /// Arrays with one row for each environment.
  struct Arrays {
    std::vector<float> observations, final_observations;
    std::vector<double> rewards, numbers, final_numbers;
    std::vector<std::uint8_t> terminated, truncated, succeeded;
    std::vector<std::uint8_t> ended;  ///< kSameStep: the row of final_* was written in this step
  };

  /// @param threads  that step, the caller's included; >= 1
  VectorEnvironment(std::shared_ptr<const EnvironmentSetup> setup, int count, int threads,
                    Autoreset autoreset);

  Autoreset autoreset() const { return autoreset_; }
  int size() const { return static_cast<int>(environments_.size()); }
  const Task& task() const { return *environments_.front()->agents().front().task; }
  const Environment& environment(int index) const { return *environments_.at(index); }
  Environment& environment(int index) { return *environments_.at(index); }
  const Arrays& arrays() const { return arrays_; }

  /// Begins episodes. @param seeds  of each environment, or nothing: the next episode
  /// @param chosen  which environments; empty: all
  void reset(const std::vector<std::optional<std::uint64_t>>& seeds,
             const std::vector<std::uint8_t>& chosen);
  /// One period of every environment. @param actions  (size, actions), finite; limited to -1..1
  /// @pre an episode of each has begun and, without autoreset, is not over
  /// @throws the exception of the first environment that failed
  void step(std::span<const float> actions);

 private:
  void step_one(int index, std::span<const float> action);
  void store(int index);

  Autoreset autoreset_;
  std::vector<std::unique_ptr<Environment>> environments_;
  Arrays arrays_;
  Workers workers_;
};

}  // namespace vinerow::tasks
