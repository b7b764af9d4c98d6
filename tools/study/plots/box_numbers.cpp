#include "tools/study/plots/box_numbers.h"

#include <algorithm>
#include <cmath>

#include "engine/math/statistics.h"
#include "tools/study/plots/quantity.h"

namespace vinerow::study {
std::optional<BoxNumbers> calc_box_numbers(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !can_draw(value); });
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  BoxNumbers box;
  box.lower_quartile = quantile(values, 0.25);
  box.median = quantile(values, 0.5);
  box.upper_quartile = quantile(values, 0.75);
  const double reach = 1.5 * (box.upper_quartile - box.lower_quartile);
  // Without a value between the box and its reach, the whisker ends at the box.
  box.low_whisker =
      std::min(*std::lower_bound(values.begin(), values.end(), box.lower_quartile - reach),
               box.lower_quartile);
  box.high_whisker = std::max(
      *std::prev(std::upper_bound(values.begin(), values.end(), box.upper_quartile + reach)),
      box.upper_quartile);
  return box;
}

}  // namespace vinerow::study
