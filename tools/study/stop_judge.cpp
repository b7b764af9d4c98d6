#include "tools/study/stop_judge.h"

#include <algorithm>
#include <cmath>

#include "tools/study/statistics.h"

namespace vinerow::study {

StopJudge::StopJudge(const Results& results)
    : results_(results), wanted_(results.design().settings(), results.design().seeds()) {
  const std::optional<scenario::StopRule>& rule = results.design().study().stop;
  if (!rule) return;
  numbers_.emplace(results);
  std::fill(wanted_.begin(), wanted_.end(), static_cast<std::size_t>(rule->at_least));
}

bool StopJudge::is_narrow(std::size_t setting, std::size_t seeds) {
  const scenario::StopRule& rule = *results_.design().study().stop;
  std::vector<double> values;
  for (std::size_t k = 0; k < seeds; ++k) {
    const double value = numbers_->value(results_.design().cell_of(setting, k), rule.metric);
    if (std::isfinite(value)) values.push_back(value);
  }
  // Missing values do not narrow the interval of the others.
  if (values.size() < static_cast<std::size_t>(rule.at_least)) return false;
  const Interval interval = t_interval(values, rule.confidence);
  const double half_width = 0.5 * (interval.high - interval.low);
  const double mean = 0.5 * (interval.high + interval.low);
  return half_width <= (rule.relative ? rule.half_width * std::abs(mean) : rule.half_width);
}

std::size_t StopJudge::wanted(std::size_t setting) {
  const std::size_t max_seeds = results_.design().seeds();
  std::size_t& wanted = wanted_[setting];
  while (wanted < max_seeds) {
    for (std::size_t k = 0; k < wanted; ++k) {
      if (!is_finished(results_.state(results_.design().cell_of(setting, k)))) return wanted;
    }
    if (is_narrow(setting, wanted)) return wanted;
    ++wanted;
  }
  return wanted;
}

}  // namespace vinerow::study
