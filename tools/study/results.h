#pragma once
/// Results of all cells of a study, in memory.

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tools/study/cell.h"
#include "tools/study/design.h"

namespace vinerow::study {

/// Marks a number that a cell lacks or could not measure.
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

class Results {
 public:
  /// All cells are waiting. @param design  outlives the results
  explicit Results(const Design& design);

  const Design& design() const { return design_; }
  void put(std::size_t cell, const CellResult& result);

  CellState state(std::size_t cell) const { return cells_[cell].state; }
  const std::string& reason(std::size_t cell) const { return cells_[cell].reason; }
  const std::string& digest(std::size_t cell) const { return cells_[cell].digest; }
  const CellCost& cost(std::size_t cell) const { return cells_[cell].cost; }

  /// Names of all numbers that at least one cell has, sorted.
  std::vector<std::string> names() const;
  bool has(const std::string& name) const { return places_.contains(name); }
  /// kNoNumber if absent.
  double value(std::size_t cell, const std::string& name) const;

  /// True if the runs of every setting with several finished seeds have one digest, and there is
  /// such a setting: nothing in the scenario is random, and intervals over the seeds say nothing.
  bool seeds_change_nothing() const;

  /// Number of cells in each state.
  std::map<CellState, std::size_t> counts() const;

 private:
  struct Cell {
    CellState state = CellState::kWaiting;
    std::string reason, digest;
    CellCost cost;
    std::vector<double> values;  ///< indexed by places_; may be shorter
  };
  const Design& design_;
  std::vector<Cell> cells_;
  std::map<std::string, std::size_t> places_;
};

}  // namespace vinerow::study
