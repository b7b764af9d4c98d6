#include "tools/study/results.h"

namespace vinerow::study {

Results::Results(const Design& design) : design_(design), cells_(design.cells()) {}

void Results::put(std::size_t cell, const CellResult& result) {
  Cell& kept = cells_[cell];
  kept.state = result.state;
  kept.reason = result.reason;
  kept.digest = result.digest;
  kept.cost = result.cost;
  kept.values.assign(places_.size(), kNoNumber);
  for (const auto& [name, value] : result.values) {
    const std::size_t place = places_.emplace(name, places_.size()).first->second;
    if (place >= kept.values.size()) kept.values.resize(place + 1, kNoNumber);
    kept.values[place] = value;
  }
}

std::vector<std::string> Results::names() const {
  std::vector<std::string> names;
  for (const auto& [name, place] : places_) names.push_back(name);
  return names;
}

double Results::value(std::size_t cell, const std::string& name) const {
  const auto found = places_.find(name);
  const std::vector<double>& values = cells_[cell].values;
  return found == places_.end() || found->second >= values.size() ? kNoNumber
                                                                  : values[found->second];
}

bool Results::seeds_change_nothing() const {
  bool has_several = false;
  for (std::size_t setting = 0; setting < design_.settings(); ++setting) {
    const std::string* first = nullptr;
    for (std::size_t k = 0; k < design_.seeds(); ++k) {
      const Cell& cell = cells_[design_.cell_of(setting, k)];
      if (!has_numbers(cell.state)) continue;
      if (first != nullptr && cell.digest != *first) return false;
      has_several = has_several || first != nullptr;
      first = &cell.digest;
    }
  }
  return has_several;
}

std::map<CellState, std::size_t> Results::counts() const {
  std::map<CellState, std::size_t> counts;
  for (const Cell& cell : cells_) ++counts[cell.state];
  return counts;
}

}  // namespace vinerow::study
