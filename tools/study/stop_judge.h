#pragma once
/// How many seeds a setting needs.

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/scenario/study.h"
#include "tools/study/numbers.h"
#include "tools/study/results.h"

namespace vinerow::study {

/// The rule of `stop`. What it says of a setting depends on the results of its first seeds alone,
/// and so neither on the number of workers nor on the order in which cells finish.
class StopJudge {
 public:
  /// @param results  outlives the judge
  explicit StopJudge(const Results& results);

  /// How many of a setting's seeds are wanted: the fewest, at least `at_least`, over which the
  /// interval is narrow enough; while some of these are not finished, so many as are known to be
  /// wanted. All of them without a rule.
  std::size_t wanted(std::size_t setting);

 private:
  bool is_narrow(std::size_t setting, std::size_t seeds);

  const Results& results_;
  std::vector<std::size_t> wanted_;  ///< by setting; only grows
  std::optional<Numbers> numbers_;   ///< where there is a rule
};

}  // namespace vinerow::study
