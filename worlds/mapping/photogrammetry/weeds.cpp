#include "worlds/mapping/photogrammetry/weeds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"
#include "engine/math/polyline.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;

double distance_to_rows_m(const Vector2d& p, const std::vector<PlantRow>& rows) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const PlantRow& row : rows) {
    for (std::size_t i = 0; i + 1 < row.line_W.size(); ++i) {
      nearest_m = std::min(nearest_m, distance_to_segment_m<2>(p, row.line_W[i].head<2>(),
                                                               row.line_W[i + 1].head<2>()));
    }
  }
  return nearest_m;
}

}  // namespace

Weeds::Weeds(const WeedsOptions& options, const std::vector<PlantRow>& rows, const SurveyArea& area,
             RandomStream random) {
  VINEROW_DEMAND(options.height_m >= 0.0 && options.tufts_per_m2 >= 0.0 &&
                 options.radius_low_m > 0.0 && options.radius_low_m <= options.radius_high_m);
  if (options.height_m == 0.0) return;
  const Eigen::AlignedBox2d box = area.box_W();
  const auto count = static_cast<std::int64_t>(options.tufts_per_m2 * box.volume());
  cell_m_ = std::max(cell_m_, options.radius_high_m);
  corner_W_ = box.min();
  columns_ = static_cast<int>(box.sizes().x() / cell_m_) + 1;
  rows_ = static_cast<int>(box.sizes().y() / cell_m_) + 1;
  std::vector<Tuft> all;
  for (std::int64_t k = 0; k < count; ++k) {
    Tuft tuft;
    tuft.p_W.x() = random.uniform(box.min().x(), box.max().x());
    tuft.p_W.y() = random.uniform(box.min().y(), box.max().y());
    tuft.radius_m = random.uniform(options.radius_low_m, options.radius_high_m);
    tuft.height_m = options.height_m * random.uniform(0.3, 1.0);
    if (distance_to_rows_m(tuft.p_W, rows) >= options.offset_from_rows_m + tuft.radius_m) {
      all.push_back(tuft);
    }
  }
  const auto cell_of_tuft = [&](const Tuft& tuft) {
    const Vector2d at = (tuft.p_W - corner_W_) / cell_m_;
    return cell_of(std::min(static_cast<int>(at.x()), columns_ - 1),
                   std::min(static_cast<int>(at.y()), rows_ - 1));
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const Tuft& a, const Tuft& b) { return cell_of_tuft(a) < cell_of_tuft(b); });
  first_.assign(cell_of(0, rows_) + 1, 0);
  for (const Tuft& tuft : all) ++first_[cell_of_tuft(tuft) + 1];
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  tufts_ = std::move(all);
}

double Weeds::height_m(const Vector2d& p_W) const {
  if (tufts_.empty()) return 0.0;
  const Vector2d at = (p_W - corner_W_) / cell_m_;
  if (!(at.x() >= -1.0 && at.y() >= -1.0 && at.x() <= columns_ + 1.0 && at.y() <= rows_ + 1.0)) {
    return 0.0;
  }
  const int column = static_cast<int>(std::floor(at.x())),
            row = static_cast<int>(std::floor(at.y()));
  double highest_m = 0.0;
  for (int j = std::max(row - 1, 0); j <= std::min(row + 1, rows_ - 1); ++j) {
    for (int i = std::max(column - 1, 0); i <= std::min(column + 1, columns_ - 1); ++i) {
      for (std::uint32_t k = first_[cell_of(i, j)]; k < first_[cell_of(i, j) + 1]; ++k) {
        const Tuft& tuft = tufts_[k];
        const double share2 = (p_W - tuft.p_W).squaredNorm() / (tuft.radius_m * tuft.radius_m);
        highest_m = std::max(highest_m, tuft.height_m * (1.0 - share2));
      }
    }
  }
  return highest_m;
}

}  // namespace vinerow::mapping
