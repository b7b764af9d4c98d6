#pragma once
/// Cell of a study: one run and its result.

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "engine/api/registry.h"
#include "engine/scenario/scenario.h"
#include "engine/scenario/study.h"
#include "engine/sim/run_shelf.h"

namespace vinerow::study {

/// From kMet to kOutOfMemory a cell is finished: it has run and need not run again.
enum class CellState {
  kWaiting,
  kNotNeeded,  ///< the stop rule needed fewer seeds
  kMet,        ///< all criteria met
  kNotMet,     ///< a criterion or a phase failed, or a vehicle crashed
  kBrokenOff,  ///< the simulation broke off
  kInvalid,    ///< the scenario is invalid with this cell's values
  kCrashed,    ///< the program crashed
  kOutOfTime,
  kOutOfMemory
};
/// "waiting", "not needed", "met", "not met", "broken off", "invalid", "crashed", "out of time",
/// "out of memory".
const char* to_string(CellState state);
/// Inverse of to_string(). @throws ConfigError for another word
CellState cell_state_of(const std::string& word);
bool is_finished(CellState state);
/// Whether the cell's numbers count in statistics: it ran to its end.
bool has_numbers(CellState state);

/// Computing cost of a cell. It differs from run to run; no result depends on it.
struct CellCost {
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double peak_MB = 0.0;
  std::string host;
};

struct CellResult {
  CellState state = CellState::kWaiting;
  std::string reason;  ///< one sentence unless the state is kMet
  std::string digest;  ///< digest of the run
  /// "<vehicle>.<metric>", "<phase>.<number of its job>", "planning.<vehicle>.<number>",
  /// "run.met", "run.finished" (0 or 1), "run.simulated_s"; for a mission also "run.phases",
  /// "run.phases_succeeded"
  std::map<std::string, double> values;
  CellCost cost;
};

/// Content of a cell's file; non-finite numbers are written as text. cell_result_of() reads it.
std::string cell_json(const CellResult& result);
/// @param file  named in errors @throws ConfigError
CellResult cell_result_of(const std::string& json, const std::string& file);

/// Runs a cell in this process. Every fault of the run becomes its state and reason.
/// @param shelf  cache shared by the cells of a process
/// @param folder  folder for the run's files; empty: none are written
/// @throws WriteError if they cannot be stored, which is no result of the cell
CellResult run_cell(const scenario::ScenarioSource& source, const scenario::Overrides& overrides,
                    const Registry& registry, const std::shared_ptr<RunShelf>& shelf,
                    scenario::KeepRuns keep, const std::filesystem::path& folder);

}  // namespace vinerow::study
