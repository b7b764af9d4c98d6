#pragma once
/// Numbers of a box plot.
///
/// Source: J. W. Tukey, "Exploratory Data Analysis", 1977, chapter 2; quartiles by definition 7 of
/// R. J. Hyndman, Y. Fan, "Sample Quantiles in Statistical Packages", 1996.

#include <optional>
#include <vector>

namespace vinerow::study {

struct BoxNumbers {
  double lower_quartile = 0.0, median = 0.0, upper_quartile = 0.0;
  /// Smallest and largest value within 1.5 interquartile ranges of the box.
  double low_whisker = 0.0, high_whisker = 0.0;

  bool is_outlier(double value) const { return value < low_whisker || value > high_whisker; }
};

/// Ignores values that cannot be drawn; nullopt if there are no others.
std::optional<BoxNumbers> calc_box_numbers(std::vector<double> values);

}  // namespace vinerow::study
