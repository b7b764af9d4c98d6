#include "worlds/mapping/rows/canopy_raster.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/math/statistics.h"

namespace vinerow::mapping {

CanopyRaster make_canopy_raster(const ParcelCloud& cloud, const HeightAbove& height_above,
                                double cell_m, double low_m, double high_m) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : cloud.points) box.extend(p);
  CanopyRaster raster;
  raster.cell_m = cell_m;
  raster.corner = {std::floor(box.min().x()), std::floor(box.min().y())};
  const Eigen::Vector2d size = box.max().head<2>().cast<double>() - raster.corner;
  constexpr double kMaxSquares = 400e6;
  if ((size.x() / cell_m + 1.0) * (size.y() / cell_m + 1.0) > kMaxSquares) {
    throw ConfigError(
        fmt::format("the cloud is {:.0f} m x {:.0f} m, too large to look for rows in one piece; "
                    "cut it into parcels",
                    size.x(), size.y()));
  }
  raster.columns = static_cast<int>(size.x() / cell_m) + 1;
  raster.rows = static_cast<int>(size.y() / cell_m) + 1;

  std::vector<std::uint32_t> counts(static_cast<std::size_t>(raster.columns) * raster.rows, 0);
  for_chunks(cloud.points.size(), kPointsAtOnce,
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t k = begin; k < end; ++k) {
                 const Eigen::Vector3f& p = cloud.points[k];
                 const float height_m = height_above(p);
                 if (!(height_m > low_m && height_m < high_m)) continue;
                 const std::int64_t cell = raster.cell_of(p.x(), p.y());
                 if (cell < 0) continue;
                 std::atomic_ref<std::uint32_t>(counts[static_cast<std::size_t>(cell)])
                     .fetch_add(1, std::memory_order_relaxed);
               }
             });
  // What a square of canopy holds on the average; squares at its rim hold less.
  std::uint64_t sum = 0, occupied = 0;
  for (const std::uint32_t count : counts) {
    sum += count;
    occupied += count > 0 ? 1 : 0;
  }
  const float full = occupied > 0 ? static_cast<float>(sum) / static_cast<float>(occupied) : 1.0f;
  raster.weights.resize(counts.size());
  for (std::size_t k = 0; k < counts.size(); ++k) {
    raster.weights[k] = std::min(1.0f, static_cast<float>(counts[k]) / full);
  }
  return raster;
}

double body_height_m(const ParcelCloud& cloud, const HeightAbove& height_above, double cut_m,
                     double high_m) {
  constexpr double kBody = 0.6, kHighest_m = 1.1;
  const std::size_t step = std::max<std::size_t>(1, cloud.points.size() / 2'000'000);
  std::vector<float> heights;
  for (std::size_t k = 0; k < cloud.points.size(); k += step) {
    const float height_m = height_above(cloud.points[k]);
    if (height_m > cut_m && height_m < high_m) heights.push_back(height_m);
  }
  if (heights.empty()) return cut_m;
  return std::clamp(kBody * upper_median(heights), cut_m, std::max(cut_m, kHighest_m));
}

CanopyRaster coarsen(const CanopyRaster& raster, int factor) {
  CanopyRaster coarse;
  coarse.cell_m = raster.cell_m * factor;
  coarse.corner = raster.corner;
  coarse.columns = (raster.columns + factor - 1) / factor;
  coarse.rows = (raster.rows + factor - 1) / factor;
  coarse.weights.assign(static_cast<std::size_t>(coarse.columns) * coarse.rows, 0.0f);
  const float share = 1.0f / static_cast<float>(factor * factor);
  for (int j = 0; j < raster.rows; ++j) {
    for (int i = 0; i < raster.columns; ++i) {
      coarse.weights[static_cast<std::size_t>(j / factor) * coarse.columns + i / factor] +=
          share * raster.weights[static_cast<std::size_t>(j) * raster.columns + i];
    }
  }
  return coarse;
}

}  // namespace vinerow::mapping
