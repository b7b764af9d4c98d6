#include "tools/study/setting_numbers.h"

#include <cmath>
#include <cstdint>

#include "tools/study/numbers.h"

namespace vinerow::study {

std::vector<SettingNumber> setting_numbers(const Results& results, const std::string& name) {
  const Design& design = results.design();
  Numbers numbers(results);
  std::vector<SettingNumber> all(design.settings());
  for (std::size_t cell = 0; cell < design.cells(); ++cell) {
    SettingNumber& setting = all[design.setting_of(cell)];
    const double value = numbers.value(cell, name);
    if (std::isfinite(value)) {
      setting.values.push_back(value);
      setting.cells.push_back(cell);
    } else if (setting.note.empty()) {
      setting.note = has_numbers(results.state(cell)) ? "not measured"
                     : results.reason(cell).empty()   ? to_string(results.state(cell))
                                                      : results.reason(cell);
    }
  }
  for (SettingNumber& setting : all) {
    setting.mean = summarise(setting.values).mean;
    setting.interval = t_interval(setting.values, kConfidence);
  }
  return all;
}

Interval SettingCount::met_interval() const {
  return wilson_interval(static_cast<std::int64_t>(met), static_cast<std::int64_t>(finished),
                         kConfidence);
}

SettingCount count_setting(const Results& results, std::size_t setting) {
  SettingCount count;
  for (std::size_t k = 0; k < results.design().seeds(); ++k) {
    const CellState state = results.state(results.design().cell_of(setting, k));
    count.finished += is_finished(state) ? 1 : 0;
    count.met += state == CellState::kMet ? 1 : 0;
    count.failed += is_finished(state) && !has_numbers(state) ? 1 : 0;
  }
  return count;
}

}  // namespace vinerow::study
