#pragma once
/// Numbers of a cell by name: metrics, derived columns, numeric factors.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/derived.h"
#include "tools/study/results.h"

namespace vinerow::study {

/// Number in a text, if the whole text is a number.
std::optional<double> number_in(const std::string& text);

class Numbers {
 public:
  /// @param results  outlives this; may grow
  explicit Numbers(const Results& results);

  /// NaN if absent. A cell that did not run to the end has no metrics.
  double value(std::size_t cell, const std::string& name);

 private:
  double factor(std::size_t cell, std::size_t column) const;

  const Results& results_;
  std::map<std::string, std::size_t> factors_;     ///< index among the design's columns
  std::map<std::string, Expression> expressions_;  ///< expressions of derived columns
};

}  // namespace vinerow::study
