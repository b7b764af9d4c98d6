#include "worlds/mapping/rows/row_direction.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "engine/core/parallel.h"

// Derivation, for one window of radius R with canopy weights w at (x, y):
//
//   P_a(t) = sum of w over the squares with -x sin a + y cos a = t    profile across direction a
//   a*     = argmax of sum_t P_a(t)^2                                 direction of the rows
//
// The sum of P_a is the canopy, the same for every a, so that the largest mean square belongs to
// the profile with the sharpest peaks: along the rows. Its period follows from
//
//   v(t) = P(t) / chord(t),  chord(t) = 2 sqrt(R^2 - t^2)             without the window's shape
//   r(l) = sum (v(t) - m)(v(t + l) - m) / sum (v(t) - m)^2            autocorrelation, m = mean v
//
// spacing = first large peak of r, refined by a parabola through three lags, and
// likelihood = (r(spacing) - min r before it) / 2: r = 1 at the peak and -1 in the trough give 1.

namespace vinerow::mapping {
namespace {

// As the squares of the canopy raster.
constexpr double kProfileBin_m = 0.1;
constexpr double kDegrees = std::numbers::pi / 180.0;

/// A raster square with canopy, relative to the window's middle.
struct Square {
  float x, y, weight;
};

std::vector<Square> squares_around(const CanopyRaster& raster, const Eigen::Vector2d& middle,
                                   double radius_m) {
  const auto bounds = [&](double at, double corner, int count) {
    const double from = (at - radius_m - corner) / raster.cell_m;
    const double to = (at + radius_m - corner) / raster.cell_m;
    return std::pair{std::max(0, static_cast<int>(from)),
                     std::min(count - 1, static_cast<int>(std::max(-1.0, to)))};
  };
  const auto [i0, i1] = bounds(middle.x(), raster.corner.x(), raster.columns);
  const auto [j0, j1] = bounds(middle.y(), raster.corner.y(), raster.rows);
  std::vector<Square> squares;
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const float weight = raster.weights[static_cast<std::size_t>(j) * raster.columns + i];
      if (weight <= 0.0f) continue;
      const Eigen::Vector2d d = raster.middle_of(i, j) - middle;
      if (d.squaredNorm() > radius_m * radius_m) continue;
      squares.push_back({static_cast<float>(d.x()), static_cast<float>(d.y()), weight});
    }
  }
  return squares;
}

/// Profile P_a in bins. Each square is shared between the two bins next to it.
class Profile {
  // Two blurs reach three bins to each side.
  static constexpr double kBlurReach_bins = 6.0;

 public:
  explicit Profile(double radius_m)
      : reach_m_(radius_m + kBlurReach_bins * kProfileBin_m),
        bins_(static_cast<std::size_t>(std::ceil(2.0 * reach_m_ / kProfileBin_m)) + 2, 0.0f) {}

  void fill(const std::vector<Square>& squares, double angle_rad) {
    std::fill(bins_.begin(), bins_.end(), 0.0f);
    const float nx = static_cast<float>(-std::sin(angle_rad) / kProfileBin_m);
    const float ny = static_cast<float>(std::cos(angle_rad) / kProfileBin_m);
    const float zero = static_cast<float>(reach_m_ / kProfileBin_m);
    for (const Square& square : squares) {
      const float at = nx * square.x + ny * square.y + zero;
      const auto low = static_cast<std::size_t>(at);
      const float share = at - static_cast<float>(low);
      bins_[low] += (1.0f - share) * square.weight;
      bins_[low + 1] += share * square.weight;
    }
    // A mean over 0.4 m, forwards and backwards, so that it shifts nothing. Without it the grid of
    // the raster squares would give peaks at angles along its axes.
    blur();
    std::reverse(bins_.begin(), bins_.end());
    blur();
    std::reverse(bins_.begin(), bins_.end());
  }
  /// Sum of squares. The number of bins is constant, so that it ranks as the mean does.
  double mean_square() const {
    double sum = 0.0;
    for (const float bin : bins_) sum += static_cast<double>(bin) * bin;
    return sum;
  }
  const std::vector<float>& bins() const { return bins_; }
  double offset_of(double bin) const { return bin * kProfileBin_m - reach_m_; }

 private:
  /// Mean of each bin and the three before it.
  void blur() {
    float b1 = 0.0f, b2 = 0.0f, b3 = 0.0f;
    for (float& bin : bins_) {
      const float own = bin;
      bin = 0.25f * (own + b1 + b2 + b3);
      b3 = b2, b2 = b1, b1 = own;
    }
  }

  double reach_m_;
  std::vector<float> bins_;
};

/// a* in [0, pi), by a full search and two refinements around the best angle.
double best_angle(const std::vector<Square>& squares, Profile& profile) {
  // Chosen: at R = 10 m, 2 degrees move a row's end by 0.35 m, less than its width; 0.04 degrees
  // move it by 7 mm.
  constexpr double kCoarse_rad = 2.0 * kDegrees, kFine_rad = 0.2 * kDegrees;
  constexpr double kFinest_rad = 0.04 * kDegrees;
  double best_rad = 0.0, best = -1.0;
  const auto search = [&](double middle_rad, double reach_rad, double step_rad) {
    const int steps = static_cast<int>(std::lround(reach_rad / step_rad));
    for (int k = -steps; k <= steps; ++k) {
      const double angle_rad = middle_rad + k * step_rad;
      profile.fill(squares, angle_rad);
      const double score = profile.mean_square();
      if (score <= best) continue;
      best = score;
      best_rad = angle_rad;
    }
  };
  search(0.5 * std::numbers::pi, 0.5 * std::numbers::pi, kCoarse_rad);
  search(best_rad, kCoarse_rad, kFine_rad);
  search(best_rad, kFine_rad, kFinest_rad);
  best_rad = std::fmod(best_rad, std::numbers::pi);
  return best_rad < 0.0 ? best_rad + std::numbers::pi : best_rad;
}

/// v(t): the profile over that of an even cover of the round window; 0 where the chord is short.
std::vector<double> levelled(const Profile& profile, const RowPatchOptions& options,
                             double square_m) {
  const double radius_m = options.radius_m;
  std::vector<double> level(profile.bins().size(), 0.0);
  for (std::size_t k = 0; k < level.size(); ++k) {
    const double y = profile.offset_of(static_cast<double>(k));
    const double chord_m = 2.0 * std::sqrt(std::max(0.0, radius_m * radius_m - y * y));
    if (chord_m < options.min_chord * radius_m) continue;
    level[k] = profile.bins()[k] * square_m * square_m / (chord_m * kProfileBin_m);
  }
  return level;
}

struct Period {
  double spacing_m, likelihood;
};

/// Period of v by the first large peak of the autocorrelation r; null without one.
std::optional<Period> period_of(const std::vector<double>& level, const RowPatchOptions& options) {
  // Inner part, where the chord is long enough.
  std::size_t first = 0, last = level.size();
  const auto [low, high] = std::minmax_element(level.begin(), level.end());
  if (*high <= *low) return std::nullopt;
  while (first < last && level[first] == 0.0) ++first;
  while (last > first && level[last - 1] == 0.0) --last;
  const std::vector<double> inner(level.begin() + static_cast<std::ptrdiff_t>(first),
                                  level.begin() + static_cast<std::ptrdiff_t>(last));
  double mean = 0.0;
  for (const double value : inner) mean += value;
  mean /= std::max<double>(1.0, static_cast<double>(inner.size()));
  double own = 0.0;
  for (const double value : inner) own += (value - mean) * (value - mean);
  // r(lag), divided by the spread of the whole profile and not of the overlap: two pieces of bare
  // ground would correlate well.
  const auto correlation = [&](std::size_t lag) {
    double sum = 0.0;
    for (std::size_t k = 0; k + lag < inner.size(); ++k) {
      sum += (inner[k] - mean) * (inner[k + lag] - mean);
    }
    return sum / own;
  };
  // A lag beyond two thirds of the profile has too little overlap.
  const auto lag_low = static_cast<std::size_t>(options.spacing_low_m / kProfileBin_m);
  const auto lag_high = std::min(static_cast<std::size_t>(options.spacing_high_m / kProfileBin_m),
                                 inner.size() * 2 / 3);
  if (lag_high < lag_low + 2) return std::nullopt;
  std::vector<double> values;
  for (std::size_t lag = 0; lag <= lag_high + 1; ++lag) values.push_back(correlation(lag));
  double highest = 0.0;
  for (std::size_t lag = lag_low; lag <= lag_high; ++lag) highest = std::max(highest, values[lag]);
  for (std::size_t lag = lag_low; lag <= lag_high; ++lag) {
    const bool is_peak = values[lag] >= values[lag - 1] && values[lag] >= values[lag + 1];
    if (!is_peak || values[lag] < options.first_peak * highest || values[lag] < options.min_peak) {
      continue;
    }
    const double trough =
        *std::min_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(lag) + 1);
    // Vertex of the parabola through the peak and its neighbours, within half a bin.
    const double bend = values[lag - 1] - 2.0 * values[lag] + values[lag + 1];
    const double shift =
        bend < 0.0 ? std::clamp(0.5 * (values[lag - 1] - values[lag + 1]) / bend, -0.5, 0.5) : 0.0;
    return Period{(static_cast<double>(lag) + shift) * kProfileBin_m,
                  std::clamp(0.5 * (values[lag] - trough), 0.0, 1.0)};
  }
  return std::nullopt;
}

/// Offsets of the rows: for every local maximum of v that is high enough, the centre of
/// mass of v around it.
std::vector<double> peaks_of(const std::vector<double>& level, const Profile& profile,
                             double spacing_m, const RowPatchOptions& options) {
  const double highest = *std::max_element(level.begin(), level.end());
  const auto reach =
      static_cast<std::ptrdiff_t>(std::lround(options.row_reach * spacing_m / kProfileBin_m));
  const auto count = static_cast<std::ptrdiff_t>(level.size());
  std::vector<double> offsets;
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    const double value = level[static_cast<std::size_t>(k)];
    if (value < highest / options.row_peak_over) continue;
    bool is_highest = true;
    double sum = 0.0, moment = 0.0;
    for (std::ptrdiff_t n = std::max<std::ptrdiff_t>(0, k - reach);
         n <= std::min(count - 1, k + reach); ++n) {
      const double other = level[static_cast<std::size_t>(n)];
      is_highest = is_highest && (other < value || (other == value && n >= k));
      sum += other;
      moment += other * static_cast<double>(n);
    }
    if (is_highest) offsets.push_back(profile.offset_of(moment / sum));
  }
  return offsets;
}

/// Rows in one window; null if it holds almost no canopy.
std::optional<RowPatch> look_at(const CanopyRaster& raster, const Eigen::Vector2d& middle,
                                const RowPatchOptions& options) {
  const std::vector<Square> squares = squares_around(raster, middle, options.radius_m);
  double canopy_m2 = 0.0;
  for (const Square& square : squares) canopy_m2 += square.weight;
  canopy_m2 *= raster.cell_m * raster.cell_m;
  if (canopy_m2 < options.min_canopy * options.radius_m * options.radius_m) return std::nullopt;
  Profile profile(options.radius_m);
  RowPatch patch;
  patch.middle = middle;
  patch.canopy_m2 = canopy_m2;
  patch.angle_rad = best_angle(squares, profile);
  profile.fill(squares, patch.angle_rad);
  const std::vector<double> level = levelled(profile, options, raster.cell_m);
  const auto period = period_of(level, options);
  if (!period) return patch;
  patch.spacing_m = period->spacing_m;
  patch.likelihood = period->likelihood;
  patch.offsets_m = peaks_of(level, profile, patch.spacing_m, options);
  return patch;
}

}  // namespace

std::vector<RowPatch> find_row_patches(const CanopyRaster& raster, const RowPatchOptions& options) {
  const auto count = [&](int squares) {
    return std::max(1, static_cast<int>(std::ceil(squares * raster.cell_m / options.radius_m)));
  };
  const int columns = count(raster.columns), rows = count(raster.rows);
  std::vector<std::optional<RowPatch>> found(static_cast<std::size_t>(columns) * rows);
  for_chunks(found.size(), 4, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<double>(k % static_cast<std::size_t>(columns));
      const auto j = static_cast<double>(k / static_cast<std::size_t>(columns));
      const Eigen::Vector2d middle =
          raster.corner + options.radius_m * Eigen::Vector2d(i + 0.5, j + 0.5);
      found[k] = look_at(raster, middle, options);
    }
  });
  std::vector<RowPatch> patches;
  for (auto& patch : found) {
    if (patch) patches.push_back(std::move(*patch));
  }
  return patches;
}

double median_spacing_m(const std::vector<RowPatch>& patches) {
  std::vector<std::pair<double, double>> sorted;
  double all = 0.0;
  for (const RowPatch& patch : patches) {
    const double weight = patch.likelihood * patch.canopy_m2;
    sorted.emplace_back(patch.spacing_m, weight);
    all += weight;
  }
  std::sort(sorted.begin(), sorted.end());
  double below = 0.0;
  for (const auto& [spacing_m, weight] : sorted) {
    below += weight;
    if (below >= 0.5 * all) return spacing_m;
  }
  return sorted.back().first;
}

std::vector<RowPatch> consistent_windows(const std::vector<RowPatch>& patches,
                                         const RowPatchOptions& options) {
  // Directions are axes, so that angles are doubled.
  const double parallel = std::cos(2.0 * options.parallel_deg * std::numbers::pi / 180.0);
  // Windows are R apart; 3 R, with a margin for rounding.
  constexpr double kAround = 3.01;
  std::vector<RowPatch> likely;
  for (const RowPatch& patch : patches) {
    if (patch.likelihood >= options.likely) likely.push_back(patch);
  }
  if (likely.empty()) return {};
  const double spacing_m = median_spacing_m(likely);
  std::vector<RowPatch> consistent;
  for (const RowPatch& patch : likely) {
    if (patch.spacing_m < options.narrow * spacing_m) continue;
    if (patch.spacing_m > options.wide * spacing_m) continue;
    double with = 0.0, all = 0.0;
    for (const RowPatch& other : patches) {
      const double apart_m = (other.middle - patch.middle).norm();
      if (apart_m == 0.0 || apart_m > kAround * options.radius_m) continue;
      all += other.canopy_m2;
      if (other.likelihood < options.likely) continue;
      if (std::cos(2.0 * (other.angle_rad - patch.angle_rad)) >= parallel) with += other.canopy_m2;
    }
    if (with >= options.agreeing * all) consistent.push_back(patch);
  }
  return consistent;
}

std::vector<std::vector<RowPatch>> other_patches(const std::vector<RowPatch>& patches,
                                                 const std::vector<RowPatch>& consistent,
                                                 const RowPatchOptions& options) {
  const double parallel = std::cos(2.0 * options.other_parallel_deg * std::numbers::pi / 180.0);
  // Between the distances of a diagonal neighbour, 1.41 R, and of the next but one, 2 R.
  constexpr double kAdjacent = 1.5;
  std::vector<RowPatch> left;
  for (const RowPatch& patch : patches) {
    const bool is_taken =
        std::any_of(consistent.begin(), consistent.end(),
                    [&](const RowPatch& other) { return other.middle == patch.middle; });
    if (!is_taken && patch.likelihood >= options.clear) left.push_back(patch);
  }
  const auto are_consistent = [&](const RowPatch& a, const RowPatch& b) {
    return (a.middle - b.middle).norm() < kAdjacent * options.radius_m &&
           std::cos(2.0 * (a.angle_rad - b.angle_rad)) >= parallel &&
           std::max(a.spacing_m, b.spacing_m) <=
               options.other_spacing * std::min(a.spacing_m, b.spacing_m);
  };
  // Connected components, by growing each from its first window.
  std::vector<std::vector<RowPatch>> groups;
  std::vector<bool> used(left.size(), false);
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (used[k]) continue;
    used[k] = true;
    std::vector<RowPatch> group{left[k]};
    for (std::size_t n = 0; n < group.size(); ++n) {
      for (std::size_t m = 0; m < left.size(); ++m) {
        if (used[m] || !are_consistent(group[n], left[m])) continue;
        used[m] = true;
        group.push_back(left[m]);
      }
    }
    if (group.size() > 1) groups.push_back(std::move(group));
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return groups;
}

}  // namespace vinerow::mapping
