#pragma once
/// One run of a study and what became of it.

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "engine/api/registry.h"
#include "engine/scenario/scenario.h"
#include "engine/scenario/study.h"
#include "engine/sim/run_shelf.h"

namespace vinerow::study {

/// From kMet to kOutOfMemory a cell is finished: it has been run and need not be run again.
enum class CellState {
  kWaiting,
  kNotNeeded,  ///< the stop rule was content with fewer seeds
  kMet,        ///< all criteria
  kNotMet,     ///< a criterion or a phase failed, or a vehicle crashed
  kBrokenOff,  ///< the simulation ended before its end
  kInvalid,    ///< the scenario with this cell's values is refused
  kCrashed,    ///< the program did
  kOutOfTime,
  kOutOfMemory
};
/// "waiting", "not needed", "met", "not met", "broken off", "invalid", "crashed", "out of time",
/// "out of memory".
const char* to_string(CellState state);
/// @throws ConfigError for another word
CellState cell_state_of(const std::string& word);
bool is_finished(CellState state);
/// Whether the cell's numbers count in statistics: it ran to its end.
bool has_numbers(CellState state);

/// What a cell took. Differs from run to run; no result depends on it.
struct CellCost {
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double peak_MB = 0.0;
  std::string host;
};

struct CellResult {
  CellState state = CellState::kWaiting;
  std::string reason;  ///< one sentence, where the state is not kMet
  std::string digest;  ///< of the run
  /// "<vehicle>.<metric>", "<phase>.<number of its job>", "planning.<vehicle>.<number>",
  /// "run.met", "run.finished" (0 or 1), "run.simulated_s"; of a mission "run.phases",
  /// "run.phases_succeeded"
  std::map<std::string, double> values;
  CellCost cost;
};

/// Text of a cell's file; what is not finite is written as a text. cell_result_of() reads it.
std::string cell_json(const CellResult& result);
/// @param file  named in errors @throws ConfigError
CellResult cell_result_of(const std::string& json, const std::string& file);

/// Runs a cell in this process; whatever the run does wrong becomes its state and reason.
/// @param shelf  what cells of one process share
/// @param folder  where the run's files go; empty: none
/// @throws WriteError where they cannot be stored, which says nothing of the cell
CellResult run_cell(const scenario::ScenarioSource& source, const scenario::Overrides& overrides,
                    const Registry& registry, const std::shared_ptr<RunShelf>& shelf,
                    scenario::KeepRuns keep, const std::filesystem::path& folder);

}  // namespace vinerow::study
