#include "worlds/mapping/rows/cloud_terrain.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"

// Plan
//
//   1. Coarse surface c(x, y), cells of coarse_cell_m: a low quantile of each cell's heights,
//   filled
//      in and smoothed. It removes the slope.
//   2. r = z - c(x, y) of every point goes into the histogram of its terrain cell.
//   3. The ground of a cell is the lowest peak of its histogram (lowest_peak), by mean shift from a
//      low quantile: middle <- mean of the r within peak_reach_bins of middle.
//   4. Samples above the morphological opening (the largest of the smallest neighbours) by more
//      than a step are removed: canopy, walls, hedges (remove_outliers).
//   5. Holes are filled from their border (fill_in), all samples smoothed with their weights
//      (smooth), and c is added again.
//
// Thresholds: CloudTerrainOptions. Constants below are chosen too.

namespace vinerow::mapping {
namespace {

using Eigen::Vector3f;

// Limits of memory. The terrain's histograms then take 3.6 GB if all cells are full, and those of
// the coarse surface 2 GB.
constexpr double kMaxCells = 4e6;
constexpr double kMaxCoarseCells = 250e3;
// A cloud with fewer points than this contains some far from the parcel: rows need 60 per m2.
constexpr double kMinPerM2 = 0.25;
constexpr double kSmall_m2 = 1e4;  // clouds up to this area may be sparser
constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

/// Histograms that several threads fill. Sums of integers do not depend on the order.
class Histograms {
 public:
  Histograms(std::size_t cells, int bins)
      : bins_(static_cast<std::size_t>(bins)), counts_(cells * bins_, 0) {}
  void add(std::size_t cell, int bin) {
    std::atomic_ref<std::uint32_t>(counts_[cell * bins_ + static_cast<std::size_t>(bin)])
        .fetch_add(1, std::memory_order_relaxed);
  }
  const std::uint32_t* of(std::size_t cell) const { return counts_.data() + cell * bins_; }

 private:
  std::size_t bins_;
  std::vector<std::uint32_t> counts_;
};

/// Grid of `columns` x `rows` samples, `cell` apart. A sample's cell is the square around it.
struct Lattice {
  float corner_x = 0, corner_y = 0, cell = 1;  // of sample (0, 0), from the cloud's origin
  int columns = 2, rows = 2;

  Lattice(const Eigen::AlignedBox3f& box, double cell_m) : cell(static_cast<float>(cell_m)) {
    const auto fit = [&](float low, float high, float& corner, int& count) {
      corner = std::floor(low / cell) * cell;
      const double steps = std::ceil((static_cast<double>(high) - corner) / cell);
      count = static_cast<int>(std::min(steps, 1e8)) + 1;
      count = std::max(count, 2);
    };
    fit(box.min().x(), box.max().x(), corner_x, columns);
    fit(box.min().y(), box.max().y(), corner_y, rows);
  }
  std::size_t size() const { return static_cast<std::size_t>(columns) * rows; }
  double cells() const { return static_cast<double>(columns) * rows; }
  std::size_t cell_of(const Vector3f& p) const {
    const int i = std::clamp(static_cast<int>((p.x() - corner_x) / cell + 0.5f), 0, columns - 1);
    const int j = std::clamp(static_cast<int>((p.y() - corner_y) / cell + 0.5f), 0, rows - 1);
    return static_cast<std::size_t>(j) * columns + i;
  }
};

// Chosen: margin of the coarse histograms beyond the bulk of the heights.
constexpr float kRangeMargin_m = 2.0f;

/// Range of heights without the lowest and highest thousandth, plus a margin: those are false
/// matches.
std::pair<float, float> height_range(const ParcelCloud& cloud) {
  // Chosen: enough for quantiles of 0.1 %, which then rest on 200 points.
  constexpr std::size_t kSamples = 200'000, kCutOneIn = 1000;
  const std::size_t step = std::max<std::size_t>(1, cloud.points.size() / kSamples);
  std::vector<float> heights;
  for (std::size_t k = 0; k < cloud.points.size(); k += step) {
    heights.push_back(cloud.points[k].z());
  }
  std::sort(heights.begin(), heights.end());
  const std::size_t cut = heights.size() / kCutOneIn;
  return {heights[cut] - kRangeMargin_m, heights[heights.size() - 1 - cut] + kRangeMargin_m};
}

/// Fills NaN samples with the mean of those of their 3 x 3 neighbours that have a height, round by
/// round until all have one; all become 0 if none has. A round uses the heights before it, and
/// visits the border of the holes only, so that the cost is linear in the samples.
void fill_in(std::vector<float>& heights, int columns, int rows) {
  if (std::all_of(heights.begin(), heights.end(), [](float h) { return std::isnan(h); })) {
    std::fill(heights.begin(), heights.end(), 0.0f);
  }
  const auto for_each_around = [&](std::size_t at, const auto& look) {
    const int i = static_cast<int>(at % columns), j = static_cast<int>(at / columns);
    for (int v = std::max(0, j - 1); v <= std::min(rows - 1, j + 1); ++v) {
      for (int u = std::max(0, i - 1); u <= std::min(columns - 1, i + 1); ++u) {
        look(static_cast<std::size_t>(v) * columns + u);
      }
    }
  };
  std::vector<std::uint8_t> is_queued(heights.size(), 0);
  std::vector<std::size_t> border;
  const auto queue_around = [&](std::size_t at) {
    for_each_around(at, [&](std::size_t other) {
      if (!std::isnan(heights[other]) || is_queued[other] != 0) return;
      is_queued[other] = 1;
      border.push_back(other);
    });
  };
  for (std::size_t at = 0; at < heights.size(); ++at) {
    if (!std::isnan(heights[at])) queue_around(at);
  }
  std::vector<float> means;
  while (!border.empty()) {
    means.clear();
    for (const std::size_t at : border) {
      double sum = 0.0;
      int count = 0;
      for_each_around(at, [&](std::size_t other) {
        if (std::isnan(heights[other])) return;
        sum += heights[other];
        ++count;
      });
      means.push_back(static_cast<float>(sum / count));
    }
    const std::vector<std::size_t> filled = std::exchange(border, {});
    for (std::size_t k = 0; k < filled.size(); ++k) heights[filled[k]] = means[k];
    for (const std::size_t at : filled) queue_around(at);
  }
}

/// Smooths with the binomial kernel [1 4 6 4 1] / 16 along both axes:
/// h <- sum k w h / sum k w, w <- sum k w / sum k. @pre weights > 0
void smooth(std::vector<float>& heights, std::vector<float>& weights, int columns, int rows) {
  constexpr double kKernel[] = {1.0, 4.0, 6.0, 4.0, 1.0};
  const auto pass = [&](int count, int lines, std::size_t along, std::size_t across) {
    std::vector<float> h(static_cast<std::size_t>(count)), w(h.size());
    for (int line = 0; line < lines; ++line) {
      const std::size_t start = static_cast<std::size_t>(line) * across;
      for (int k = 0; k < count; ++k) {
        double sum = 0.0, weight = 0.0, kernel = 0.0;
        for (int n = -2; n <= 2; ++n) {
          if (k + n < 0 || k + n >= count) continue;
          const std::size_t at = start + static_cast<std::size_t>(k + n) * along;
          const double share = kKernel[n + 2] * weights[at];
          sum += share * heights[at];
          weight += share;
          kernel += kKernel[n + 2];
        }
        h[static_cast<std::size_t>(k)] = static_cast<float>(sum / weight);
        w[static_cast<std::size_t>(k)] = static_cast<float>(weight / kernel);
      }
      for (int k = 0; k < count; ++k) {
        heights[start + static_cast<std::size_t>(k) * along] = h[static_cast<std::size_t>(k)];
        weights[start + static_cast<std::size_t>(k) * along] = w[static_cast<std::size_t>(k)];
      }
    }
  };
  const auto stride = static_cast<std::size_t>(columns);
  pass(columns, rows, 1, stride);
  pass(rows, columns, stride, 1);
}

void check_extent(const Eigen::AlignedBox3f& box, std::size_t points, const Lattice& lattice,
                  const Lattice& coarse) {
  const double width_m = box.sizes().x(), depth_m = box.sizes().y();
  const double area_m2 = width_m * depth_m;
  if (area_m2 > kSmall_m2 && static_cast<double>(points) < kMinPerM2 * area_m2) {
    throw ConfigError(
        fmt::format("the cloud's {} points are spread over {:.0f} m x {:.0f} m, less than one in "
                    "{:g} m2; remove points that are far off, or cut it into parcels",
                    points, width_m, depth_m, 1.0 / kMinPerM2));
  }
  if (lattice.cells() > kMaxCells || coarse.cells() > kMaxCoarseCells) {
    throw ConfigError(
        fmt::format("the cloud is {:.0f} m x {:.0f} m, too large for a terrain of {:g} m cells; "
                    "cut it into parcels",
                    width_m, depth_m, lattice.cell));
  }
}

/// Coarse surface c: the coarse_share quantile of each cell's heights, filled in and smoothed.
HeightField coarse_surface(const ParcelCloud& cloud, const Lattice& lattice,
                           const CloudTerrainOptions& options) {
  // Chosen: 0.2 m is a tenth of the margin; 2000 bins limit the memory on a steep parcel.
  constexpr float kBin_m = 0.2f;
  constexpr int kMaxBins = 2000;
  constexpr std::uint64_t kMinPoints = 5;  // chosen: fewer give no quantile
  const std::pair<float, float> range = height_range(cloud);
  const float low = range.first, high = range.second;
  const int bins = std::clamp(static_cast<int>((high - low) / kBin_m), 1, kMaxBins);
  const float per_bin = static_cast<float>(bins) / (high - low);
  Histograms histograms(lattice.size(), bins);
  for_chunks(cloud.points.size(), kPointsAtOnce,
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t k = begin; k < end; ++k) {
                 const Vector3f& p = cloud.points[k];
                 if (p.z() < low || p.z() >= high) continue;
                 histograms.add(lattice.cell_of(p),
                                std::min(bins - 1, static_cast<int>((p.z() - low) * per_bin)));
               }
             });
  HeightField field;
  field.columns = lattice.columns;
  field.rows = lattice.rows;
  field.cell_m = options.coarse_cell_m;
  field.corner_W = {lattice.corner_x, lattice.corner_y};
  field.heights_m.assign(lattice.size(), kNoHeight);
  for (std::size_t cell = 0; cell < lattice.size(); ++cell) {
    const std::uint32_t* counts = histograms.of(cell);
    std::uint64_t all = 0;
    for (int b = 0; b < bins; ++b) all += counts[b];
    if (all < kMinPoints) continue;
    std::uint64_t below = 0;
    for (int b = 0; b < bins; ++b) {
      below += counts[b];
      if (static_cast<double>(below) < options.coarse_share * static_cast<double>(all)) continue;
      field.heights_m[cell] = low + (static_cast<float>(b) + 0.5f) / per_bin;
      break;
    }
  }
  // The cloud is so sparse that no cell has kMinPoints: a level surface at its low end.
  if (std::all_of(field.heights_m.begin(), field.heights_m.end(),
                  [](float h) { return std::isnan(h); })) {
    std::fill(field.heights_m.begin(), field.heights_m.end(), low + kRangeMargin_m);
  }
  fill_in(field.heights_m, field.columns, field.rows);
  std::vector<float> weights(field.heights_m.size(), 1.0f);
  smooth(field.heights_m, weights, field.columns, field.rows);
  return field;
}

// Range of r. Chosen: ditches down to 1.5 m, canopy up to 3 m.
constexpr float kLow_m = -1.5f, kHigh_m = 3.0f, kHeightBin_m = 0.02f;
constexpr int kHeightBins = 225;  // (kHigh_m - kLow_m) / kHeightBin_m

struct Ground {
  float height_m = kNoHeight;  // r
  float weight = 0.0f;         // number of points
  double square_sum = 0.0;     // of their squared distances from it, m2
};

/// Mode of the histogram that mean shift reaches from a low quantile; no ground if there are too
/// few points.
Ground lowest_peak(const std::uint32_t* counts, const CloudTerrainOptions& options) {
  constexpr std::uint64_t kMinPoints = 3;  // chosen: fewer do not share a height
  std::uint64_t all = 0;
  for (int b = 0; b < kHeightBins; ++b) all += counts[b];
  if (all < kMinPoints) return {};
  std::uint64_t below = 0;
  int start = 0;
  while (start < kHeightBins) {
    below += counts[start];
    if (static_cast<double>(below) >= options.low_share * static_cast<double>(all)) break;
    ++start;
  }
  // Mean shift. The quantile is on the lower flank of the peak, so that the start is 2 bins above
  // it.
  constexpr double kAboveQuantile = 2.0;
  const double reach = options.peak_reach_bins;
  constexpr int kRounds = 6;
  constexpr double kSettled = 0.02;  // bins: 0.4 mm
  double middle = start + kAboveQuantile, sum = 0.0, squares = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    double moment = 0.0;
    sum = squares = 0.0;
    const int from = std::max(0, static_cast<int>(std::ceil(middle - reach)));
    const int to = std::min(kHeightBins - 1, static_cast<int>(std::floor(middle + reach)));
    for (int b = from; b <= to; ++b) {
      sum += counts[b];
      moment += counts[b] * (b - middle);
      squares += counts[b] * (b - middle) * (b - middle);
    }
    if (sum == 0.0) break;
    middle += moment / sum;
    if (std::abs(moment / sum) < kSettled) break;
  }
  Ground ground;
  ground.height_m = kLow_m + (static_cast<float>(middle) + 0.5f) * kHeightBin_m;
  ground.weight = static_cast<float>(sum);
  ground.square_sum = squares * kHeightBin_m * kHeightBin_m;
  return ground;
}

/// Removes samples that are more than `step` above the morphological opening of the heights with a
/// square of 2 radius + 1 cells: the maximum of the minimum, each as a pass along both axes.
void remove_outliers(std::vector<Ground>& ground, int columns, int rows, int radius, float step) {
  const auto filter = [&](const std::vector<float>& from, bool is_lowest) {
    const auto pass = [&](const std::vector<float>& in, int count, int lines, std::size_t along,
                          std::size_t across) {
      std::vector<float> out(in.size());
      for (int line = 0; line < lines; ++line) {
        for (int k = 0; k < count; ++k) {
          float best = kNoHeight;
          for (int n = std::max(0, k - radius); n <= std::min(count - 1, k + radius); ++n) {
            const float h =
                in[static_cast<std::size_t>(line) * across + static_cast<std::size_t>(n) * along];
            if (std::isnan(h)) continue;
            if (std::isnan(best) || (is_lowest ? h < best : h > best)) best = h;
          }
          out[static_cast<std::size_t>(line) * across + static_cast<std::size_t>(k) * along] = best;
        }
      }
      return out;
    };
    const auto stride = static_cast<std::size_t>(columns);
    return pass(pass(from, columns, rows, 1, stride), rows, columns, stride, 1);
  };
  std::vector<float> heights(ground.size());
  for (std::size_t k = 0; k < ground.size(); ++k) heights[k] = ground[k].height_m;
  const std::vector<float> opened = filter(filter(heights, true), false);
  for (std::size_t k = 0; k < ground.size(); ++k) {
    if (!(ground[k].height_m <= opened[k] + step)) ground[k] = {};
  }
}

}  // namespace

HeightAbove::HeightAbove(const HeightField& field, const Eigen::Vector3d& origin_W)
    : field_(field),
      corner_x_(static_cast<float>(field.corner_W.x() - origin_W.x())),
      corner_y_(static_cast<float>(field.corner_W.y() - origin_W.y())),
      per_cell_(static_cast<float>(1.0 / field.cell_m)),
      origin_z_(origin_W.z()) {}

float HeightAbove::operator()(const Eigen::Vector3f& p) const {
  const float gx = std::clamp((p.x() - corner_x_) * per_cell_, 0.0f, field_.columns - 1.0f);
  const float gy = std::clamp((p.y() - corner_y_) * per_cell_, 0.0f, field_.rows - 1.0f);
  const int i = std::min(static_cast<int>(gx), field_.columns - 2);
  const int j = std::min(static_cast<int>(gy), field_.rows - 2);
  const float u = gx - static_cast<float>(i), v = gy - static_cast<float>(j);
  const float* low = field_.heights_m.data() + static_cast<std::size_t>(j) * field_.columns + i;
  const float* high = low + field_.columns;
  const float ground = u >= v ? low[0] + u * (low[1] - low[0]) + v * (high[1] - low[1])
                              : low[0] + v * (high[0] - low[0]) + u * (high[1] - high[0]);
  return static_cast<float>(p.z() + origin_z_ - ground);
}

CloudTerrain fit_terrain(const ParcelCloud& cloud, double cell_m,
                         const CloudTerrainOptions& options) {
  VINEROW_DEMAND(!cloud.points.empty() && cell_m > 0.0);
  Eigen::AlignedBox3f box;
  for (const Vector3f& p : cloud.points) box.extend(p);
  const Lattice lattice(box, cell_m), coarse_lattice(box, options.coarse_cell_m);
  check_extent(box, cloud.points.size(), lattice, coarse_lattice);
  const HeightField coarse = coarse_surface(cloud, coarse_lattice, options);
  const HeightAbove above_coarse(coarse, Eigen::Vector3d::Zero());
  Histograms histograms(lattice.size(), kHeightBins);
  for_chunks(
      cloud.points.size(), kPointsAtOnce, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const Vector3f& p = cloud.points[k];
          const float r = above_coarse(p);
          if (!(r >= kLow_m && r < kHigh_m)) continue;
          histograms.add(lattice.cell_of(p),
                         std::min(kHeightBins - 1, static_cast<int>((r - kLow_m) / kHeightBin_m)));
        }
      });

  std::vector<Ground> ground(lattice.size());
  CloudTerrain terrain;
  for (std::size_t cell = 0; cell < lattice.size(); ++cell) {
    ground[cell] = lowest_peak(histograms.of(cell), options);
    if (ground[cell].weight > 0.0f) terrain.covered_m2 += cell_m * cell_m;
  }
  const auto cells = [&](double reach_m) {
    return std::max(1, static_cast<int>(std::ceil(reach_m / cell_m)));
  };
  remove_outliers(ground, lattice.columns, lattice.rows, cells(options.small_reach_m),
                  static_cast<float>(options.small_step_m));
  remove_outliers(ground, lattice.columns, lattice.rows, cells(options.wide_reach_m),
                  static_cast<float>(options.wide_step_m));

  // Weights for smoothing: filled-in samples weigh little, full ones all the same.
  const auto filled_in = static_cast<float>(options.filled_weight);
  const auto full_points = static_cast<float>(options.full_points);
  HeightField& field = terrain.field;
  field.columns = lattice.columns;
  field.rows = lattice.rows;
  field.cell_m = cell_m;
  field.corner_W = {cloud.origin_W.x() + lattice.corner_x, cloud.origin_W.y() + lattice.corner_y};
  std::vector<float> weights(lattice.size());
  double squares = 0.0, points = 0.0;
  for (std::size_t cell = 0; cell < lattice.size(); ++cell) {
    field.heights_m.push_back(ground[cell].height_m);
    weights[cell] = filled_in + std::min(1.0f, ground[cell].weight / full_points);
    squares += ground[cell].square_sum;
    points += ground[cell].weight;
  }
  terrain.noise_m = points > 0.0 ? std::sqrt(squares / points) : 0.0;
  fill_in(field.heights_m, field.columns, field.rows);
  smooth(field.heights_m, weights, field.columns, field.rows);
  for (int j = 0; j < lattice.rows; ++j) {
    for (int i = 0; i < lattice.columns; ++i) {
      const double base = coarse.height_m(lattice.corner_x + static_cast<double>(i) * lattice.cell,
                                          lattice.corner_y + static_cast<double>(j) * lattice.cell);
      float& height = field.heights_m[static_cast<std::size_t>(j) * lattice.columns + i];
      height = static_cast<float>(height + base + cloud.origin_W.z());
    }
  }
  return terrain;
}

}  // namespace vinerow::mapping
