#include "worlds/mapping/rows/row_points.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "engine/core/parallel.h"
#include "worlds/mapping/rows/row_locator.h"

namespace vinerow::mapping {
namespace {

constexpr float kHighestLeaf_m = 6.0f;  // above the ground; what is higher is a bird or a mast
constexpr float kBeyondEnds_m = 0.2f;   // of a row's ends: its outermost leaves

void count_up(std::uint32_t& counter) {
  std::atomic_ref<std::uint32_t>(counter).fetch_add(1, std::memory_order_relaxed);
}

/// Half the width that contains 95 % of the points of a row's body.
std::vector<float> half_widths(const ParcelCloud& cloud, const HeightAbove& above,
                               const RowLocator& locator, const std::vector<double>& reach_m,
                               const RowPointOptions& options) {
  constexpr int kWidthBins = 64;
  const std::size_t rows = reach_m.size();
  std::vector<float> bin_m;
  for (const double reach : reach_m) bin_m.push_back(static_cast<float>(reach / kWidthBins));
  std::vector<std::uint32_t> counts(rows * kWidthBins, 0);
  for_chunks(cloud.points.size(), kPointsAtOnce,
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t k = begin; k < end; ++k) {
                 const Eigen::Vector3f& p = cloud.points[k];
                 const float height_m = above(p);
                 if (!(height_m > options.body_cut_m && height_m < kHighestLeaf_m)) continue;
                 const RowPlace place = locator.locate(p.x(), p.y());
                 if (place.row < 0) continue;
                 const auto r = static_cast<std::size_t>(place.row);
                 const int bin =
                     std::min(kWidthBins - 1, static_cast<int>(std::abs(place.y_m) / bin_m[r]));
                 count_up(counts[r * kWidthBins + static_cast<std::size_t>(bin)]);
               }
             });
  std::vector<float> widths;
  for (std::size_t r = 0; r < rows; ++r) {
    std::uint64_t all = 0, below = 0;
    for (int b = 0; b < kWidthBins; ++b)
      all += counts[r * kWidthBins + static_cast<std::size_t>(b)];
    int bin = 0;
    while (bin < kWidthBins - 1) {
      below += counts[r * kWidthBins + static_cast<std::size_t>(bin)];
      if (static_cast<double>(below) >= 0.95 * static_cast<double>(all)) break;
      ++bin;
    }
    widths.push_back(bin_m[r] * static_cast<float>(bin + 1));
  }
  return widths;
}

/// Going down from the cut: the height below which there are few points.
float base_of(const std::vector<double>& counts, float bin_m, float cut_m) {
  const auto cut = static_cast<std::size_t>(cut_m / bin_m);
  const std::size_t over = std::min(counts.size(), cut + static_cast<std::size_t>(0.5f / bin_m));
  double full = 0.0;
  for (std::size_t b = cut + 1; b < over; ++b) full += counts[b];
  full /= static_cast<double>(over - cut - 1);
  if (full <= 0.0) return cut_m;
  constexpr double kShare = 0.5;
  constexpr float kLowest_m = 0.2f;
  for (std::size_t b = cut; bin_m * static_cast<float>(b) >= kLowest_m; --b) {
    if (counts[b] < kShare * full) {
      // Between the middles of this bin and the one above, where the count passes the share.
      const double above = b == cut ? full : counts[b + 1];
      const double part =
          std::clamp((above - kShare * full) / std::max(1e-9, above - counts[b]), 0.0, 1.0);
      return std::min(cut_m, bin_m * static_cast<float>(static_cast<double>(b) + 1.5 - part));
    }
  }
  return cut_m;
}

/// Base of the canopy along every row.
std::vector<CanopyBase> canopy_bases(const ParcelCloud& cloud, const HeightAbove& above,
                                     const RowLocator& locator, const std::vector<RowCurve>& lines,
                                     const std::vector<float>& widths,
                                     const RowPointOptions& options) {
  constexpr float kBaseBin_m = 0.05f, kMargin_m = 0.05f;
  const int bins = static_cast<int>(std::ceil((options.canopy_cut_m + 0.6) / kBaseBin_m));
  std::vector<CanopyBase> bases(lines.size());
  std::vector<std::size_t> first{0};
  for (std::size_t r = 0; r < lines.size(); ++r) {
    const double stretches = std::ceil(lines[r].length_m() / bases[r].stretch_m);
    bases[r].height_m.resize(static_cast<std::size_t>(std::max(1.0, stretches)));
    first.push_back(first.back() + bases[r].height_m.size());
  }
  std::vector<std::uint32_t> counts(first.back() * static_cast<std::size_t>(bins), 0);
  const auto stretch_of = [&](const RowPlace& place) {
    const auto r = static_cast<std::size_t>(place.row);
    const int last = static_cast<int>(bases[r].height_m.size()) - 1;
    return first[r] + static_cast<std::size_t>(
                          std::clamp(static_cast<int>(place.s_m / bases[r].stretch_m), 0, last));
  };
  for_chunks(cloud.points.size(), kPointsAtOnce,
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t k = begin; k < end; ++k) {
                 const Eigen::Vector3f& p = cloud.points[k];
                 const float height_m = above(p);
                 if (!(height_m >= 0.0f && height_m < kBaseBin_m * static_cast<float>(bins)))
                   continue;
                 const RowPlace place = locator.locate(p.x(), p.y());
                 if (place.row < 0) continue;
                 if (std::abs(place.y_m) > widths[static_cast<std::size_t>(place.row)] + kMargin_m)
                   continue;
                 count_up(counts[stretch_of(place) * static_cast<std::size_t>(bins) +
                                 static_cast<std::size_t>(height_m / kBaseBin_m)]);
               }
             });
  for (std::size_t r = 0; r < lines.size(); ++r) {
    const auto stretches = static_cast<std::ptrdiff_t>(bases[r].height_m.size());
    for (std::ptrdiff_t k = 0; k < stretches; ++k) {
      // With the stretches beside it: a base is of several vines.
      std::vector<double> sum(static_cast<std::size_t>(bins), 0.0);
      for (std::ptrdiff_t n = std::max<std::ptrdiff_t>(0, k - 1);
           n <= std::min(stretches - 1, k + 1); ++n) {
        for (std::size_t b = 0; b < sum.size(); ++b) {
          sum[b] += counts[(first[r] + static_cast<std::size_t>(n)) * sum.size() + b];
        }
      }
      bases[r].height_m[static_cast<std::size_t>(k)] =
          base_of(sum, kBaseBin_m, static_cast<float>(options.canopy_cut_m));
    }
  }
  return bases;
}

}  // namespace

std::vector<RowCanopy> gather_row_canopies(ParcelCloud& cloud, const HeightField& terrain,
                                           const std::vector<RowCurve>& lines,
                                           const RowPointOptions& options) {
  const HeightAbove above(terrain, cloud.origin_W);
  std::vector<double> reach_m(lines.size(), 0.5 * options.spacing_m);
  for (std::size_t r = 0; r < options.spacing_of_m.size(); ++r) {
    reach_m[r] = 0.5 * options.spacing_of_m[r];
  }
  const RowLocator locator(lines, reach_m);
  const std::vector<float> widths = half_widths(cloud, above, locator, reach_m, options);
  const std::vector<CanopyBase> bases = canopy_bases(cloud, above, locator, lines, widths, options);

  // First the classes, with the number of canopy points that every chunk has for every row, then
  // the points: every row's in the cloud's order, whatever the number of cores.
  const std::size_t rows = lines.size();
  const std::size_t chunks = (cloud.points.size() + kPointsAtOnce - 1) / kPointsAtOnce;
  std::vector<std::size_t> starts(chunks * rows, 0);
  cloud.classes.resize(cloud.points.size());
  const float cut_m = static_cast<float>(options.canopy_cut_m);
  const float body_m = static_cast<float>(options.body_cut_m);
  const float ground_m = static_cast<float>(options.ground_m);
  constexpr float kMargin_m = 0.15f;
  for_chunks(cloud.points.size(), kPointsAtOnce,
             [&](std::size_t chunk, std::size_t begin, std::size_t end) {
               for (std::size_t k = begin; k < end; ++k) {
                 const Eigen::Vector3f& p = cloud.points[k];
                 const float height_m = above(p);
                 PointClass& of = cloud.classes[k];
                 if (!(height_m > ground_m)) {
                   of = PointClass::kGround;
                   continue;
                 }
                 of = height_m > cut_m ? PointClass::kOther : PointClass::kLowVegetation;
                 if (height_m >= kHighestLeaf_m) continue;
                 const RowPlace place = locator.locate(p.x(), p.y());
                 if (place.row < 0) continue;
                 const auto r = static_cast<std::size_t>(place.row);
                 if (place.s_m < -kBeyondEnds_m ||
                     place.s_m > static_cast<float>(lines[r].length_m()) + kBeyondEnds_m) {
                   continue;
                 }
                 const CanopyBase& base = bases[r];
                 const int last = static_cast<int>(base.height_m.size()) - 1;
                 const float base_m = base.height_m[static_cast<std::size_t>(
                     std::clamp(static_cast<int>(place.s_m / base.stretch_m), 0, last))];
                 const bool is_alongside = std::abs(place.y_m) > widths[r] + kMargin_m;
                 if (height_m < base_m || (height_m <= body_m && is_alongside)) {
                   of = PointClass::kLowVegetation;
                   continue;
                 }
                 of = PointClass::kCanopy;
                 ++starts[chunk * rows + r];
               }
             });
  std::vector<RowCanopy> canopies;
  for (std::size_t r = 0; r < rows; ++r) {
    std::size_t count = 0;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      const std::size_t here = starts[chunk * rows + r];
      starts[chunk * rows + r] = count;
      count += here;
    }
    std::vector<Eigen::Vector2d> points_W;
    for (const Eigen::Vector2d& p : lines[r].points_W()) {
      points_W.push_back(p + cloud.origin_W.head<2>());
    }
    canopies.push_back({static_cast<int>(r), RowCurve(std::move(points_W)), {}});
    canopies.back().points.resize(count);
  }
  for_chunks(cloud.points.size(), kPointsAtOnce,
             [&](std::size_t chunk, std::size_t begin, std::size_t end) {
               for (std::size_t k = begin; k < end; ++k) {
                 if (cloud.classes[k] != PointClass::kCanopy) continue;
                 const Eigen::Vector3f& p = cloud.points[k];
                 const RowPlace place = locator.locate(p.x(), p.y());
                 const auto r = static_cast<std::size_t>(place.row);
                 const Eigen::Vector2d on_line = lines[r].point_W(place.s_m);
                 const float height_m = above(Eigen::Vector3f(
                     static_cast<float>(on_line.x()), static_cast<float>(on_line.y()), p.z()));
                 canopies[r].points[starts[chunk * rows + r]++] = {place.s_m, place.y_m, height_m};
               }
             });
  return canopies;
}

}  // namespace vinerow::mapping
