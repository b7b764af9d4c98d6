#pragma once
/// Main effects and two-factor interactions: influence of factors on a metric.
///
/// Source: Montgomery, "Design and analysis of experiments" (8th ed. 2013), section 5.3; for
/// missing cells, section 15.2. With y_s the mean of setting s and ȳ the mean of all y_s (each
/// setting counts once):
///
///   effect of level i           α_i  = mean of the y_s with that level - ȳ
///   interaction of levels i, j  γ_ij = mean of the y_s with both levels - ȳ - a_i - b_j
///   share of a factor                  Σ_i n_i α_i² / S
///   share of an interaction            Σ_ij n_ij γ_ij² / S,      S = Σ_s (y_s - ȳ)²
///
/// n is the number of settings of a level or cell. a_i and b_j are the row and column effects that
/// best fit the table of cells without interaction (least squares, each setting counts once). In a
/// full factorial design they are the effects α of the two factors. Then all shares are eta squared
/// and add up to at most 1; the rest belongs to interactions of three and more factors.
///
/// In any other design (`full_factorial` is false) factors are correlated:
/// - The effect and share of a factor ignore all other factors. If a level was tried only with
///   certain levels of another factor, its effect includes theirs, and the shares of all factors
///   may add up to more than 1.
/// - An interaction is the part that two factors explain together beyond the sum of their
///   contributions. Without interaction it is 0, whichever cells are missing. A missing cell is
///   NaN.
///
/// Means over few seeds scatter, and this scatter counts as variance between settings. With scatter
/// alone, the share of a factor would be (levels - 1) / (settings - 1) on average, so a small share
/// may be only scatter.

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace vinerow::study {

/// Mean of one setting of a design. Means and effects have the metric's unit.
struct SettingMean {
  std::vector<int> levels;  ///< (factors) index of the level of each factor, from 0
  double mean = 0.0;        ///< mean of the metric over the setting's seeds
};

/// Effect of one factor. NaN at a level without settings.
struct MainEffect {
  std::vector<double> means;    ///< (levels) mean of the settings with this level
  std::vector<double> effects;  ///< (levels) means minus the mean of all settings
  double share = 0.0;           ///< share of the variance between settings, 0 to 1
};

/// Interaction of two factors. Rows are levels of the first, columns levels of the second; NaN in a
/// cell without settings.
struct Interaction {
  int first = 0, second = 0;  ///< indices of the factors, first < second
  Eigen::MatrixXd means;      ///< (levels of first x levels of second) mean of the cell's settings
  Eigen::MatrixXd effects;    ///< (the same) γ_ij
  double share = 0.0;         ///< share of the variance between settings, 0 to 1
};

struct Effects {
  double mean = 0.0;                      ///< mean of all settings; NaN without settings
  bool full_factorial = false;            ///< all combinations of levels occur equally often
  std::vector<MainEffect> factors;        ///< (factors) in order of the factors
  std::vector<Interaction> interactions;  ///< every pair: (0, 1), (0, 2), ..., (1, 2), ...
};

/// Effects on a metric over the settings of a design; settings may be missing.
///
/// Shares are 0 if all settings have the same mean. Cost: one least squares problem of (settings) x
/// (levels of both) per pair of factors.
///
/// @param level_counts  (factors) number of levels of each factor, at least 1
/// @param settings      in any order; a combination of levels may occur more than once
/// @pre all of these are checked: means are finite, each setting has a level of every factor, in
///      [0, level_counts[factor])
Effects calc_effects(std::span<const int> level_counts, std::span<const SettingMean> settings);

}  // namespace vinerow::study
