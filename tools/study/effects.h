#pragma once
/// Main effects and interactions of two factors: which factor moves a metric, and how far.
///
/// Source: Montgomery, "Design and analysis of experiments" (8th ed. 2013), section 5.3; where
/// cells are missing, section 15.2. With y_s the mean of setting s and ȳ the mean of all y_s, each
/// setting counting once:
///
///   effect of level i           α_i  = mean of the y_s with that level - ȳ
///   interaction of levels i, j  γ_ij = mean of the y_s with both levels - ȳ - a_i - b_j
///   share of a factor                  Σ_i n_i α_i² / S
///   share of an interaction            Σ_ij n_ij γ_ij² / S,      S = Σ_s (y_s - ȳ)²
///
/// n counts the settings of a level or cell. a_i and b_j are the row and column effects that fit
/// the table of cells best without interaction (least squares, a setting counting once). In a full
/// factorial they are the effects α of the two factors; then all shares are eta squared, they add
/// up to at most 1, and the rest belongs to interactions of three factors and more.
///
/// In any other design (`full_factorial` is false) factors hang together:
/// - The effect and share of a factor are of that factor alone, as if no other were known. Where a
///   level was tried only beside certain levels of another factor, it also tells of those, and the
///   shares of all factors may add up to more than 1.
/// - An interaction tells what its two factors explain together beyond the sum of what each adds.
///   Without interaction it is 0, whatever cells are missing. A cell that is missing is NaN.
///
/// Means over few seeds scatter, and scatter counts as variance between settings. Were there
/// nothing else, the share of a factor would be (levels - 1) / (settings - 1) on average; so a
/// small share may be nothing but scatter.

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace vinerow::study {

/// One setting of a design. Means and effects have the metric's unit.
struct SettingMean {
  std::vector<int> levels;  ///< (factors) index of the level of each factor, from 0
  double mean = 0.0;        ///< of the metric over the setting's seeds
};

/// Of one factor. NaN at a level without settings.
struct MainEffect {
  std::vector<double> means;    ///< (levels) mean of the settings with this level
  std::vector<double> effects;  ///< (levels) the same minus the mean of all settings
  double share = 0.0;           ///< of the variance between settings, 0 to 1
};

/// Of two factors. Rows are levels of the first, columns levels of the second; NaN in a cell
/// without settings.
struct Interaction {
  int first = 0, second = 0;  ///< indices of the factors, first < second
  Eigen::MatrixXd means;      ///< (levels of first x levels of second) mean of the cell's settings
  Eigen::MatrixXd effects;    ///< (the same) γ_ij
  double share = 0.0;         ///< of the variance between settings, 0 to 1
};

struct Effects {
  double mean = 0.0;                      ///< of all settings; NaN without settings
  bool full_factorial = false;            ///< every combination of levels occurs, and equally often
  std::vector<MainEffect> factors;        ///< (factors) in their order
  std::vector<Interaction> interactions;  ///< every pair: (0, 1), (0, 2), ..., (1, 2), ...
};

/// Effects of a metric over the settings of a design, of which some may be missing.
///
/// Shares are 0 where all settings have the same mean. Cost: for each pair of factors a least
/// squares problem of (settings) x (levels of both).
///
/// @param level_counts  (factors) how many levels each factor has, at least 1
/// @param settings      in any order; a combination of levels may occur more than once
/// @pre all of these are checked: means are finite, each setting has a level of every factor, in
///      [0, level_counts[factor])
Effects calc_effects(std::span<const int> level_counts, std::span<const SettingMean> settings);

}  // namespace vinerow::study
