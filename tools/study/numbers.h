#pragma once
/// Every number of a cell by its name: metrics, derived columns, factors that are numbers.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/derived.h"
#include "tools/study/results.h"

namespace vinerow::study {

/// The number that a text is, as a whole.
std::optional<double> number_in(const std::string& text);

class Numbers {
 public:
  /// @param results  outlives this; may grow
  explicit Numbers(const Results& results);

  /// NaN where there is none. Of a cell that did not run to its end there is no metric.
  double value(std::size_t cell, const std::string& name);

 private:
  double factor(std::size_t cell, std::size_t column) const;

  const Results& results_;
  std::map<std::string, std::size_t> factors_;     ///< place among the design's columns
  std::map<std::string, Expression> expressions_;  ///< of derived columns
};

}  // namespace vinerow::study
