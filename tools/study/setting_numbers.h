#pragma once
/// Numbers over the seeds of each setting, for plots and tables of the report.

#include <cstddef>
#include <string>
#include <vector>

#include "tools/study/results.h"
#include "tools/study/statistics.h"

namespace vinerow::study {

/// Number of one setting.
struct SettingNumber {
  std::vector<double> values;      ///< finite ones, in the order of seeds
  std::vector<std::size_t> cells;  ///< cells of these values
  double mean = kNoNumber;
  Interval interval;  ///< 95 % interval of the mean; infinite below two values
  std::string note;   ///< reason for a missing value: that of the first cell
};

inline constexpr double kConfidence = 0.95;

/// Numbers by setting.
std::vector<SettingNumber> setting_numbers(const Results& results, const std::string& name);

/// Number of cells of a setting that are finished, met their criteria, or did not run to the end.
struct SettingCount {
  std::size_t finished = 0, met = 0, failed = 0;

  /// Share of the finished cells. @pre finished > 0
  double met_share() const { return static_cast<double>(met) / static_cast<double>(finished); }
  /// Wilson interval, 95 %.
  Interval met_interval() const;
};
SettingCount count_setting(const Results& results, std::size_t setting);

}  // namespace vinerow::study
