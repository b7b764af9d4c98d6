#include "worlds/mapping/rows/row_direction.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "engine/core/parallel.h"

namespace vinerow::mapping {
namespace {

constexpr double kProfileBin_m = 0.1;
// Of a window that rows can be taken from: where others agree, and where it stands against most.
constexpr double kLikely = 0.12, kClear = 0.25;

struct Square {
  float x, y, weight;  // from the window's middle
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

/// Canopy over the distance across a direction, each square shared by the two bins it lies between.
class Profile {
 public:
  explicit Profile(double radius_m)
      : reach_m_(radius_m + 6.0 * kProfileBin_m),
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
    // Over 0.4 m twice: the squares' own grid would show at angles along it.
    blur();
    std::reverse(bins_.begin(), bins_.end());
    blur();
    std::reverse(bins_.begin(), bins_.end());
  }
  double mean_square() const {
    double sum = 0.0;
    for (const float bin : bins_) sum += static_cast<double>(bin) * bin;
    return sum;
  }
  const std::vector<float>& bins() const { return bins_; }
  double offset_of(double bin) const { return bin * kProfileBin_m - reach_m_; }

 private:
  /// Mean of four bins, this one and those before it.
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

double best_angle(const std::vector<Square>& squares, Profile& profile) {
  constexpr double kDegree = std::numbers::pi / 180.0;
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
  search(0.5 * std::numbers::pi, 0.5 * std::numbers::pi, 2.0 * kDegree);
  search(best_rad, 2.0 * kDegree, 0.2 * kDegree);
  search(best_rad, 0.2 * kDegree, 0.04 * kDegree);
  best_rad = std::fmod(best_rad, std::numbers::pi);
  return best_rad < 0.0 ? best_rad + std::numbers::pi : best_rad;
}

/// The profile without the round window's own shape: divided by what an even cover would give.
std::vector<double> levelled(const Profile& profile, double radius_m, double square_m) {
  std::vector<double> level(profile.bins().size(), 0.0);
  for (std::size_t k = 0; k < level.size(); ++k) {
    const double y = profile.offset_of(static_cast<double>(k));
    const double chord_m = 2.0 * std::sqrt(std::max(0.0, radius_m * radius_m - y * y));
    if (chord_m < 0.6 * radius_m) continue;
    level[k] = profile.bins()[k] * square_m * square_m / (chord_m * kProfileBin_m);
  }
  return level;
}

struct Period {
  double spacing_m, likelihood;
};

/// First large peak of the autocorrelation.
std::optional<Period> period_of(const std::vector<double>& level, const RowPatchOptions& options) {
  // Inner part, where the chord was long enough.
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
  // Over the whole profile's spread: two pieces of bare ground are alike, but say nothing.
  const auto correlation = [&](std::size_t lag) {
    double sum = 0.0;
    for (std::size_t k = 0; k + lag < inner.size(); ++k) {
      sum += (inner[k] - mean) * (inner[k + lag] - mean);
    }
    return sum / own;
  };
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
    if (!is_peak || values[lag] < 0.75 * highest || values[lag] < 0.15) continue;
    const double trough =
        *std::min_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(lag) + 1);
    const double bend = values[lag - 1] - 2.0 * values[lag] + values[lag + 1];
    const double shift =
        bend < 0.0 ? std::clamp(0.5 * (values[lag - 1] - values[lag + 1]) / bend, -0.5, 0.5) : 0.0;
    return Period{(static_cast<double>(lag) + shift) * kProfileBin_m,
                  std::clamp(0.5 * (values[lag] - trough), 0.0, 1.0)};
  }
  return std::nullopt;
}

/// Peaks of the profile: centres of mass of what stands above a third of the highest.
std::vector<double> peaks_of(const std::vector<double>& level, const Profile& profile,
                             double spacing_m) {
  const double highest = *std::max_element(level.begin(), level.end());
  const auto reach = static_cast<std::ptrdiff_t>(std::lround(0.35 * spacing_m / kProfileBin_m));
  const auto count = static_cast<std::ptrdiff_t>(level.size());
  std::vector<double> offsets;
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    const double value = level[static_cast<std::size_t>(k)];
    if (value < highest / 3.0) continue;
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

std::optional<RowPatch> look_at(const CanopyRaster& raster, const Eigen::Vector2d& middle,
                                const RowPatchOptions& options) {
  const std::vector<Square> squares = squares_around(raster, middle, options.radius_m);
  double canopy_m2 = 0.0;
  for (const Square& square : squares) canopy_m2 += square.weight;
  canopy_m2 *= raster.cell_m * raster.cell_m;
  if (canopy_m2 < 0.01 * options.radius_m * options.radius_m) return std::nullopt;
  Profile profile(options.radius_m);
  RowPatch patch;
  patch.middle = middle;
  patch.canopy_m2 = canopy_m2;
  patch.angle_rad = best_angle(squares, profile);
  profile.fill(squares, patch.angle_rad);
  const std::vector<double> level = levelled(profile, options.radius_m, raster.cell_m);
  const auto period = period_of(level, options);
  if (!period) return patch;
  patch.spacing_m = period->spacing_m;
  patch.likelihood = period->likelihood;
  patch.offsets_m = peaks_of(level, profile, patch.spacing_m);
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

std::vector<RowPatch> agreeing_patches(const std::vector<RowPatch>& patches,
                                       const RowPatchOptions& options) {
  constexpr double kWith = 0.4;
  const double kParallel = std::cos(2.0 * 15.0 * std::numbers::pi / 180.0);
  std::vector<RowPatch> likely;
  for (const RowPatch& patch : patches) {
    if (patch.likelihood >= kLikely) likely.push_back(patch);
  }
  if (likely.empty()) return {};
  const double spacing_m = median_spacing_m(likely);
  std::vector<RowPatch> agreeing;
  for (const RowPatch& patch : likely) {
    if (patch.spacing_m < 0.75 * spacing_m || patch.spacing_m > 1.33 * spacing_m) continue;
    double with = 0.0, all = 0.0;
    for (const RowPatch& other : patches) {
      const double apart_m = (other.middle - patch.middle).norm();
      if (apart_m == 0.0 || apart_m > 3.01 * options.radius_m) continue;
      all += other.canopy_m2;
      if (other.likelihood < kLikely) continue;
      if (std::cos(2.0 * (other.angle_rad - patch.angle_rad)) >= kParallel) with += other.canopy_m2;
    }
    if (with >= kWith * all) agreeing.push_back(patch);
  }
  return agreeing;
}

std::vector<std::vector<RowPatch>> other_patches(const std::vector<RowPatch>& patches,
                                                 const std::vector<RowPatch>& agreeing,
                                                 const RowPatchOptions& options) {
  const double kParallel = std::cos(2.0 * 10.0 * std::numbers::pi / 180.0);
  constexpr double kSameSpacing = 1.2;
  std::vector<RowPatch> left;
  for (const RowPatch& patch : patches) {
    const bool is_taken = std::any_of(agreeing.begin(), agreeing.end(), [&](const RowPatch& other) {
      return other.middle == patch.middle;
    });
    if (!is_taken && patch.likelihood >= kClear) left.push_back(patch);
  }
  const auto hang_together = [&](const RowPatch& a, const RowPatch& b) {
    return (a.middle - b.middle).norm() < 1.5 * options.radius_m &&
           std::cos(2.0 * (a.angle_rad - b.angle_rad)) >= kParallel &&
           std::max(a.spacing_m, b.spacing_m) <= kSameSpacing * std::min(a.spacing_m, b.spacing_m);
  };
  std::vector<std::vector<RowPatch>> groups;
  std::vector<bool> used(left.size(), false);
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (used[k]) continue;
    used[k] = true;
    std::vector<RowPatch> group{left[k]};
    for (std::size_t n = 0; n < group.size(); ++n) {
      for (std::size_t m = 0; m < left.size(); ++m) {
        if (used[m] || !hang_together(group[n], left[m])) continue;
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
