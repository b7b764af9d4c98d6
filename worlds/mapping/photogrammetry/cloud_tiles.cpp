#include "worlds/mapping/photogrammetry/cloud_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/parallel.h"

namespace vinerow::mapping {

CloudTiles::CloudTiles(const SurveyArea& area, double further_m, double density_per_m2) {
  constexpr double kMaxPerM2 = 1e6, kWidest_m = 6.0;
  constexpr int kMaxCells = 128;
  if (!(density_per_m2 > 0.0 && density_per_m2 <= kMaxPerM2)) {
    throw ConfigError(
        fmt::format("the cloud's density is {} points per square metre, must be above 0 and at "
                    "most {:.0f}",
                    density_per_m2, kMaxPerM2));
  }
  cell_m_ = 1.0 / std::sqrt(density_per_m2);
  side_ = std::clamp(static_cast<int>(kWidest_m / cell_m_), 1, kMaxCells);
  const Eigen::AlignedBox2d box = area.box_W();
  corner_W_ = box.min() - Eigen::Vector2d(further_m, further_m);
  const Eigen::Vector2d size = box.sizes() + 2.0 * Eigen::Vector2d(further_m, further_m);
  columns_ = static_cast<std::int64_t>(std::ceil(size.x() / width_m()));
  rows_ = static_cast<std::int64_t>(std::ceil(size.y() / width_m()));
}

void stream_points(
    std::int64_t count,
    const std::function<void(std::int64_t k, std::vector<SampledPoint>& points)>& make,
    const std::function<void(std::int64_t k)>& done, const CloudSink& sink) {
  constexpr std::int64_t kAtOnce = 48;
  std::array<std::vector<SampledPoint>, kAtOnce> made;
  for (std::int64_t first = 0; first < count; first += kAtOnce) {
    const std::int64_t now = std::min(kAtOnce, count - first);
    for_chunks(static_cast<std::size_t>(now), 1, [&](std::size_t k, std::size_t, std::size_t) {
      made[k].clear();
      make(first + static_cast<std::int64_t>(k), made[k]);
    });
    for (std::int64_t k = 0; k < now; ++k) {
      const std::vector<SampledPoint>& points = made[static_cast<std::size_t>(k)];
      if (!points.empty()) sink(points);
      done(first + k);
    }
  }
}

}  // namespace vinerow::mapping
