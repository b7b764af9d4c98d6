#pragma once
/// A number over the seeds of each setting: what plots and tables of the report are made of.

#include <cstddef>
#include <string>
#include <vector>

#include "tools/study/results.h"
#include "tools/study/statistics.h"

namespace vinerow::study {

/// Of one setting.
struct SettingNumber {
  std::vector<double> values;      ///< finite ones, in the order of seeds
  std::vector<std::size_t> cells;  ///< which gave them
  double mean = kNoNumber;
  Interval interval;  ///< of the mean, 95 %; infinite below two values
  std::string note;   ///< why there is no value: reason of the first cell
};

inline constexpr double kConfidence = 0.95;

/// [setting]
std::vector<SettingNumber> setting_numbers(const Results& results, const std::string& name);

/// How many cells of a setting are finished, met their criteria, failed to run to their end.
struct SettingCount {
  std::size_t finished = 0, met = 0, failed = 0;

  /// Of the finished cells. @pre finished > 0
  double met_share() const { return static_cast<double>(met) / static_cast<double>(finished); }
  /// Wilson's, 95 %.
  Interval met_interval() const;
};
SettingCount count_setting(const Results& results, std::size_t setting);

}  // namespace vinerow::study
