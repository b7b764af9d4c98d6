#pragma once
/// Stop rule of a study: the number of seeds that a setting needs.

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/scenario/study.h"
#include "tools/study/numbers.h"
#include "tools/study/results.h"

namespace vinerow::study {

/// Judge for the key `stop`. Its result for a setting depends only on the results of the first
/// seeds, and so neither on the number of workers nor on the order in which cells finish.
class StopJudge {
 public:
  /// @param results  outlives the judge
  explicit StopJudge(const Results& results);

  /// Number of seeds that a setting needs: the smallest number, at least `at_least`, for which the
  /// interval is narrow enough. While some of these are not finished, the number known to be needed
  /// so far. Without a rule, all.
  std::size_t wanted(std::size_t setting);

 private:
  bool is_narrow(std::size_t setting, std::size_t seeds);

  const Results& results_;
  std::vector<std::size_t> wanted_;  ///< by setting; only grows
  std::optional<Numbers> numbers_;   ///< set if there is a rule
};

}  // namespace vinerow::study
