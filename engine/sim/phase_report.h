#pragma once
/// Outcome of a mission's phases.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/product.h"
#include "engine/core/time.h"

namespace vinerow {

enum class PhaseState {
  kWaiting,  ///< for other phases or for weather
  kRunning,
  kSucceeded,
  kFailed,
  kBlocked,    ///< a phase that it is `after` did not succeed
  kStopped,    ///< was running when the mission was aborted
  kNotStarted  ///< the mission ended before it could start
};
/// "waiting", "running", "succeeded", "failed", "blocked", "stopped", "not started".
const char* to_string(PhaseState state);

struct CriterionResult {
  std::string name;
  std::string metric;  ///< "rover.cross_track_rms_m"
  std::string kind;    ///< "max" | "min"
  double value = 0.0;
  double limit = 0.0;
  bool met = false;
};

struct PhaseReport {
  std::string name;
  std::vector<std::string> vehicles;  ///< empty: a job
  std::string job;                    ///< its type
  std::vector<std::string> after;
  PhaseState state = PhaseState::kWaiting;
  std::optional<Time> begin, end;
  std::string reason;  ///< one sentence, if it did not succeed
  std::vector<CriterionResult> criteria;
  std::map<std::string, double> numbers;                         ///< of a job
  std::map<std::string, std::map<std::string, double>> metrics;  ///< by vehicle, at the phase's end
  std::vector<std::string> notes;
  std::optional<Product> product;
  double wall_s = 0.0;  ///< of a job
};

}  // namespace vinerow
