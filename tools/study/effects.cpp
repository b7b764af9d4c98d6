#include "tools/study/effects.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "engine/core/check.h"
#include "tools/study/statistics.h"

namespace vinerow::study {
namespace {

// Means of the settings relative to the mean of all, and the sum of their squares.
struct Deviations {
  std::span<const SettingMean> settings;
  double mean;
  std::vector<double> values;  // (settings) y_s - ȳ
  double squares;              // S = Σ (y_s - ȳ)²
};

Deviations deviations_of(std::span<const SettingMean> settings) {
  std::vector<double> values;
  for (const SettingMean& setting : settings) values.push_back(setting.mean);
  const double mean = summarise(values).mean;
  double squares = 0.0;
  for (double& value : values) {
    value -= mean;
    squares += value * value;
  }
  return {settings, mean, values, squares};
}

double share_of(double part, double whole) {
  return whole > 0.0 ? std::min(1.0, part / whole) : 0.0;
}

MainEffect main_effect(const Deviations& deviations, std::size_t factor, int levels) {
  const auto size = static_cast<std::size_t>(levels);
  std::vector<double> sums(size, 0.0), counts(size, 0.0);
  for (std::size_t s = 0; s < deviations.values.size(); ++s) {
    const auto level = static_cast<std::size_t>(deviations.settings[s].levels[factor]);
    sums[level] += deviations.values[s];
    counts[level] += 1.0;
  }
  // α_i, and Σ n_i α_i². A level without settings has 0 / 0 = NaN and is not in the sum.
  MainEffect result;
  double part = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    const double effect = sums[i] / counts[i];
    result.effects.push_back(effect);
    result.means.push_back(deviations.mean + effect);
    if (counts[i] > 0.0) part += counts[i] * effect * effect;
  }
  result.share = share_of(part, deviations.squares);
  return result;
}

// Residual c_ij - a_i - b_j of each cell, with a, b that minimise Σ n_ij (c_ij - a_i - b_j)² over
// the existing cells. Sizes: all (levels of first x levels of second).
Eigen::MatrixXd additive_residuals(const Eigen::MatrixXd& cells, const Eigen::MatrixXd& counts) {
  const Eigen::Index rows = cells.rows(), columns = cells.cols();
  const Eigen::Index equations = (counts.array() > 0.0).count();
  // One equation per cell, √n_ij (a_i + b_j) = √n_ij c_ij; unknowns are all a, then all b.
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(equations, rows + columns);
  Eigen::VectorXd right(equations);
  Eigen::Index equation = 0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      if (!(counts(i, j) > 0.0)) continue;
      const double weight = std::sqrt(counts(i, j));
      matrix(equation, i) = weight;
      matrix(equation, rows + j) = weight;
      right(equation) = weight * cells(i, j);
      ++equation;
    }
  }
  // The unknowns are not unique (a + c, b - c), but their sums are; this is the shortest solution.
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(rows + columns);
  if (equations > 0) solution = matrix.completeOrthogonalDecomposition().solve(right);
  Eigen::MatrixXd residuals = cells;
  residuals.colwise() -= solution.head(rows);
  residuals.rowwise() -= solution.tail(columns).transpose();
  return residuals;
}

Interaction interaction(const Deviations& deviations, int first, int second, int rows,
                        int columns) {
  Eigen::MatrixXd cells = Eigen::MatrixXd::Zero(rows, columns), counts = cells;
  for (std::size_t s = 0; s < deviations.values.size(); ++s) {
    const std::vector<int>& levels = deviations.settings[s].levels;
    const int i = levels[static_cast<std::size_t>(first)];
    const int j = levels[static_cast<std::size_t>(second)];
    cells(i, j) += deviations.values[s];
    counts(i, j) += 1.0;
  }
  cells = cells.cwiseQuotient(counts).eval();  // 0 / 0 = NaN without settings

  Interaction result{first, second, (cells.array() + deviations.mean).matrix(),
                     additive_residuals(cells, counts), 0.0};
  // Σ n_ij γ_ij²: the sum of squares explained by the cells minus that explained by a_i + b_j
  // (Pythagoras).
  double part = 0.0;
  for (Eigen::Index k = 0; k < cells.size(); ++k) {
    const double effect = result.effects(k);
    if (counts(k) > 0.0) part += counts(k) * effect * effect;
  }
  result.share = share_of(part, deviations.squares);
  return result;
}

bool is_full_factorial(std::span<const int> level_counts, std::span<const SettingMean> settings) {
  double combinations = 1.0;
  for (const int levels : level_counts) combinations *= levels;
  std::map<std::vector<int>, int> occurrences;
  for (const SettingMean& setting : settings) ++occurrences[setting.levels];
  if (static_cast<double>(occurrences.size()) != combinations) return false;
  return std::all_of(occurrences.begin(), occurrences.end(), [&](const auto& entry) {
    return entry.second == occurrences.begin()->second;
  });
}

}  // namespace

Effects calc_effects(std::span<const int> level_counts, std::span<const SettingMean> settings) {
  for (const int levels : level_counts) VINEROW_DEMAND(levels > 0);
  for (const SettingMean& setting : settings) {
    VINEROW_DEMAND(setting.levels.size() == level_counts.size());
    for (std::size_t factor = 0; factor < level_counts.size(); ++factor) {
      const int level = setting.levels[factor];
      VINEROW_DEMAND(level >= 0 && level < level_counts[factor]);
    }
  }

  const Deviations deviations = deviations_of(settings);
  Effects result;
  result.mean = deviations.mean;
  result.full_factorial = is_full_factorial(level_counts, settings);
  for (std::size_t factor = 0; factor < level_counts.size(); ++factor) {
    result.factors.push_back(main_effect(deviations, factor, level_counts[factor]));
  }
  for (std::size_t first = 0; first < level_counts.size(); ++first) {
    for (std::size_t second = first + 1; second < level_counts.size(); ++second) {
      result.interactions.push_back(interaction(deviations, static_cast<int>(first),
                                                static_cast<int>(second), level_counts[first],
                                                level_counts[second]));
    }
  }
  return result;
}

}  // namespace vinerow::study
