#include "worlds/mapping/hulls/row_sections.h"

#include <algorithm>
#include <cmath>

#include "engine/math/statistics.h"

namespace vinerow::mapping {
namespace {

// Points farther out belong to no plant row; the limit bounds the memory for stray points.
constexpr float kBeyondEnds_m = 10.0f, kMaxAcross_m = 4.0f, kLowest_m = -2.0f, kHighest_m = 8.0f;
constexpr double kOccupied_m = 0.05;  // steps along the row in which gaps are looked for

/// Counts of points in cells along and across the row, to find sparse cells.
class CellFilter {
 public:
  CellFilter(const std::vector<Eigen::Vector3f>& points, const RowSliceOptions& options) {
    low_ = high_ = points.front();
    for (const Eigen::Vector3f& p : points) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
    per_m_ = Eigen::Vector3f(static_cast<float>(1.0 / options.slice_m),
                             static_cast<float>(1.0 / options.cell_m),
                             static_cast<float>(1.0 / options.cell_m));
    // A border of empty cells, so that neighbourhoods need no bounds checks.
    for (int axis = 0; axis < 3; ++axis) {
      count_[axis] = static_cast<std::size_t>((high_[axis] - low_[axis]) * per_m_[axis]) + 3;
    }
    cells_.assign(count_[0] * count_[1] * count_[2], 0);
    for (const Eigen::Vector3f& p : points) ++cells_[cell_of(p)];
    add_up();
    find_thresholds(options.thresholds);
  }

  bool is_sparse(const Eigen::Vector3f& p) const {
    const std::size_t cell = cell_of(p);
    return static_cast<float>(sums_[cell]) < thresholds_[cell / layer()];
  }

 private:
  std::size_t layer() const { return count_[1] * count_[2]; }

  std::size_t cell_of(const Eigen::Vector3f& p) const {
    const auto at = [&](int axis) {
      return static_cast<std::size_t>((p[axis] - low_[axis]) * per_m_[axis]) + 1;
    };
    return (at(0) * count_[1] + at(1)) * count_[2] + at(2);
  }

  void add_up() {
    sums_.assign(cells_.size(), 0);
    const auto row = static_cast<std::ptrdiff_t>(count_[2]);
    const auto plane = static_cast<std::ptrdiff_t>(layer());
    for (std::size_t cell = layer(); cell + layer() < cells_.size(); ++cell) {
      if (cells_[cell] == 0) continue;
      std::uint32_t sum = 0;
      for (std::ptrdiff_t i = -1; i <= 1; ++i) {
        for (std::ptrdiff_t j = -1; j <= 1; ++j) {
          const std::uint32_t* middle = cells_.data() + cell + i * plane + j * row;
          sum += middle[-1] + middle[0] + middle[1];
        }
      }
      sums_[cell] = sum;
    }
  }

  void find_thresholds(const RowSliceThresholds& thresholds) {
    // Of each layer the sums of its cells with their points; the median weighs points.
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> layers(count_[0]);
    for (std::size_t i = 0; i < count_[0]; ++i) {
      for (std::size_t cell = i * layer(); cell < (i + 1) * layer(); ++cell) {
        if (cells_[cell] > 0) layers[i].emplace_back(sums_[cell], cells_[cell]);
      }
    }
    const auto median = [](std::vector<std::pair<std::uint32_t, std::uint32_t>>& sums) {
      std::sort(sums.begin(), sums.end());
      std::uint64_t all = 0, passed = 0;
      for (const auto& [sum, points] : sums) all += points;
      for (const auto& [sum, points] : sums) {
        passed += points;
        if (2 * passed >= all) return static_cast<float>(sum);
      }
      return 0.0f;
    };
    std::vector<float> medians(count_[0]);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> gathered;
    for (const auto& sums : layers) gathered.insert(gathered.end(), sums.begin(), sums.end());
    const float row_median = median(gathered);
    for (std::size_t i = 0; i < count_[0]; ++i) medians[i] = median(layers[i]);
    thresholds_.resize(count_[0]);
    const auto reach = static_cast<std::size_t>(std::ceil(per_m_[0]));
    std::vector<float> near;
    for (std::size_t i = 0; i < count_[0]; ++i) {
      near.clear();
      for (std::size_t k = i > reach ? i - reach : 0; k <= std::min(i + reach, count_[0] - 1);
           ++k) {
        if (medians[k] > 0.0f) near.push_back(medians[k]);
      }
      const float local = near.empty() ? 0.0f : upper_median(near);
      thresholds_[i] = std::max({static_cast<float>(thresholds.local) * local,
                                 static_cast<float>(thresholds.row) * row_median,
                                 std::min(static_cast<float>(thresholds.stray),
                                          static_cast<float>(thresholds.stray_row) * row_median)});
    }
  }

  Eigen::Vector3f low_, high_, per_m_;
  std::size_t count_[3] = {};
  std::vector<std::uint32_t> cells_, sums_;  // points of each, and with its neighbours
  std::vector<float> thresholds_;            // of each layer along the row
};

double median_of_positive(std::vector<std::uint32_t> counts) {
  std::erase(counts, 0u);
  return counts.empty() ? 0.0 : upper_median(counts);
}

/// Steps along the row with canopy: enough points, and not only those of a post where vines are
/// missing.
std::vector<std::uint8_t> occupied_steps(const std::vector<std::uint32_t>& counts, double share) {
  constexpr std::size_t kPost = 6;   // steps that it takes up at most, with the points' noise
  constexpr std::size_t kApart = 2;  // empty ones on both sides
  const double min_count = share * median_of_positive(counts);
  std::vector<std::uint8_t> occupied(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    occupied[i] = counts[i] > 0 && static_cast<double>(counts[i]) >= min_count ? 1 : 0;
  }
  std::vector<std::uint8_t> canopy = occupied;
  const auto is_empty = [&](std::size_t from, std::size_t to) {
    return std::none_of(occupied.begin() + static_cast<std::ptrdiff_t>(from),
                        occupied.begin() + static_cast<std::ptrdiff_t>(to),
                        [](std::uint8_t step) { return step != 0; });
  };
  for (std::size_t i = kApart; i < occupied.size(); ++i) {
    if (occupied[i] == 0 || occupied[i - 1] != 0) continue;
    std::size_t end = i;
    while (end < occupied.size() && occupied[end] != 0) ++end;
    if (end - i > kPost || end + kApart > occupied.size()) continue;
    if (is_empty(i - kApart, i) && is_empty(end, end + kApart)) {
      std::fill(canopy.begin() + static_cast<std::ptrdiff_t>(i),
                canopy.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{0});
    }
  }
  return canopy;
}

/// End of the canopy from values of s in any order: a share of those close to the end is noise.
double robust_end(std::vector<float>& s_m, bool low, const RowSliceThresholds& thresholds) {
  const auto order = [low](float a, float b) { return low ? a < b : a > b; };
  const float outermost = *std::min_element(s_m.begin(), s_m.end(), order);
  const double sign = low ? 1.0 : -1.0;
  std::vector<float> near;
  for (const float s : s_m) {
    if (sign * (s - outermost) <= thresholds.end_m) near.push_back(s);
  }
  const auto left_out =
      static_cast<std::ptrdiff_t>(thresholds.end_share * static_cast<double>(near.size()));
  std::nth_element(near.begin(), near.begin() + left_out, near.end(), order);
  return near[static_cast<std::size_t>(left_out)];
}

/// @param low_m,high_m  where canopy is dense enough to end
RowStretch make_stretch(const std::vector<Eigen::Vector3f>& points, double low_m, double high_m,
                        const RowSliceOptions& options) {
  const RowSliceThresholds& thresholds = options.thresholds;
  RowStretch stretch;
  std::vector<float> s_m;
  s_m.reserve(points.size());
  for (const Eigen::Vector3f& p : points) {
    if (p.x() >= low_m && p.x() <= high_m) s_m.push_back(p.x());
  }
  if (s_m.empty()) return stretch;
  stretch.from_m = robust_end(s_m, true, thresholds);
  stretch.to_m = robust_end(s_m, false, thresholds);
  const double length_m = stretch.to_m - stretch.from_m;
  if (!(length_m >= thresholds.shortest_m)) return stretch;
  const double per_m = static_cast<double>(points.size()) / length_m;
  const double step_m =
      std::min(std::max(options.slice_m, thresholds.points_per_slice / per_m), 0.5 * length_m);
  const auto slices = static_cast<std::size_t>(std::ceil(length_m / step_m - 1e-6));
  const auto slice_of = [&](const Eigen::Vector3f& p) {
    const double at = (p.x() - stretch.from_m) / length_m * static_cast<double>(slices);
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(slices) - 0.5));
  };
  stretch.first.assign(slices + 1, 0);
  for (const Eigen::Vector3f& p : points) ++stretch.first[slice_of(p) + 1];
  for (std::size_t i = 0; i < slices; ++i) stretch.first[i + 1] += stretch.first[i];
  std::vector<std::size_t> next(stretch.first.begin(), stretch.first.end() - 1);
  stretch.points.resize(points.size());
  for (const Eigen::Vector3f& p : points) stretch.points[next[slice_of(p)]++] = p;
  return stretch;
}

}  // namespace

RowStretches slice_row(const RowCanopy& row, const RowSliceOptions& options) {
  RowStretches result;
  std::vector<Eigen::Vector3f> points;
  points.reserve(row.points.size());
  const auto length_m = static_cast<float>(row.line.length_m());
  for (const Eigen::Vector3f& p : row.points) {
    if (!p.allFinite()) {
      ++result.not_finite;
    } else if (p.x() < -kBeyondEnds_m || p.x() > length_m + kBeyondEnds_m ||
               std::abs(p.y()) > kMaxAcross_m || p.z() < kLowest_m || p.z() > kHighest_m) {
      ++result.sparse;
    } else {
      points.push_back(p);
    }
  }
  if (points.empty()) return result;
  {
    const CellFilter filter(points, options);
    const auto kept = std::remove_if(points.begin(), points.end(),
                                     [&](const Eigen::Vector3f& p) { return filter.is_sparse(p); });
    result.sparse += points.end() - kept;
    points.erase(kept, points.end());
  }
  if (points.empty()) return result;

  float low_m = points.front().x(), high_m = low_m;
  for (const Eigen::Vector3f& p : points) {
    low_m = std::min(low_m, p.x());
    high_m = std::max(high_m, p.x());
  }
  const auto step_of = [&](const Eigen::Vector3f& p) {
    return static_cast<std::size_t>((p.x() - low_m) / kOccupied_m);
  };
  std::vector<std::uint32_t> counts(static_cast<std::size_t>((high_m - low_m) / kOccupied_m) + 1);
  for (const Eigen::Vector3f& p : points) ++counts[step_of(p)];
  const std::vector<std::uint8_t> canopy = occupied_steps(counts, options.thresholds.occupied);
  // Points outside the canopy, and not at its rim, would widen the stretch's last section.
  const auto is_off_canopy = [&](const Eigen::Vector3f& p) {
    constexpr std::size_t kRim = 2;
    const std::size_t step = step_of(p);
    const std::size_t end = std::min(canopy.size(), step + kRim + 1);
    for (std::size_t i = step > kRim ? step - kRim : 0; i < end; ++i) {
      if (canopy[i] != 0) return false;
    }
    return true;
  };
  const auto on_canopy = std::remove_if(points.begin(), points.end(), is_off_canopy);
  result.sparse += points.end() - on_canopy;
  points.erase(on_canopy, points.end());
  // Number of the stretch that each step belongs to.
  std::vector<std::uint32_t> stretch_of(counts.size());
  const auto max_empty = static_cast<std::size_t>(options.gap_m / kOccupied_m);
  std::uint32_t stretches = 0;
  std::size_t empty = 0;
  std::vector<std::pair<double, double>> occupied_m;  // from and to, of each stretch
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const bool occupied = canopy[i] != 0;
    empty = occupied ? 0 : empty + 1;
    if (empty == max_empty) ++stretches;
    stretch_of[i] = stretches;
    occupied_m.resize(stretches + 1, {1.0, 0.0});
    if (!occupied) continue;
    const double starts_m = low_m + static_cast<double>(i) * kOccupied_m;
    auto& [from_m, to_m] = occupied_m[stretches];
    if (from_m > to_m) from_m = starts_m;
    to_m = starts_m + kOccupied_m;
  }
  std::vector<std::vector<Eigen::Vector3f>> parts(stretches + 1);
  std::vector<std::size_t> sizes(parts.size());
  for (const Eigen::Vector3f& p : points) ++sizes[stretch_of[step_of(p)]];
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].reserve(sizes[i]);
  for (const Eigen::Vector3f& p : points) parts[stretch_of[step_of(p)]].push_back(p);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::vector<Eigen::Vector3f>& part = parts[i];
    RowStretch stretch;
    if (static_cast<double>(part.size()) >= options.thresholds.fewest_points) {
      stretch = make_stretch(part, occupied_m[i].first, occupied_m[i].second, options);
    }
    if (stretch.first.empty()) {
      result.lone += static_cast<std::int64_t>(part.size());
      continue;
    }
    part = {};
    if (!result.stretches.empty()) {
      result.gaps_m.emplace_back(result.stretches.back().to_m, stretch.from_m);
    }
    result.stretches.push_back(std::move(stretch));
  }
  return result;
}

}  // namespace vinerow::mapping
