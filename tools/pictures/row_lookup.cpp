#include "tools/pictures/row_lookup.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vinerow::tools {

RowLookup::RowLookup(const std::vector<PlantRow>& rows, double reach_m) {
  Eigen::AlignedBox2d box;
  for (const PlantRow& row : rows) {
    for (const Eigen::Vector3d& p : row.line_W) box.extend(Eigen::Vector2d(p.head<2>()));
  }
  if (box.isEmpty()) return;
  constexpr double kMaxCells = 2e7;
  const Eigen::Vector2d size = box.sizes() + Eigen::Vector2d::Constant(2.0 * reach_m);
  cell_m_ = std::max(cell_m_, std::sqrt(size.prod() / kMaxCells));
  corner_W_ = box.min() - Eigen::Vector2d::Constant(reach_m);
  columns_ = static_cast<int>(std::ceil(size.x() / cell_m_)) + 1;
  rows_ = static_cast<int>(std::ceil(size.y() / cell_m_)) + 1;
  nearest_.assign(static_cast<std::size_t>(columns_) * rows_, -1);
  std::vector<float> apart_m(nearest_.size(), static_cast<float>(reach_m));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto& line_W = rows[r].line_W;
    for (std::size_t k = 0; k + 1 < line_W.size(); ++k) {
      const Eigen::Vector2d a = line_W[k].head<2>(), d = line_W[k + 1].head<2>() - a;
      const Eigen::Vector2d from = a.cwiseMin(a + d) - Eigen::Vector2d::Constant(reach_m);
      const Eigen::Vector2d to = a.cwiseMax(a + d) + Eigen::Vector2d::Constant(reach_m);
      const auto index = [&](double value, double corner, int cells) {
        return std::clamp(static_cast<int>((value - corner) / cell_m_), 0, cells - 1);
      };
      const int last_i = index(to.x(), corner_W_.x(), columns_);
      const int last_j = index(to.y(), corner_W_.y(), rows_);
      for (int j = index(from.y(), corner_W_.y(), rows_); j <= last_j; ++j) {
        for (int i = index(from.x(), corner_W_.x(), columns_); i <= last_i; ++i) {
          const Eigen::Vector2d p = corner_W_ + cell_m_ * Eigen::Vector2d(i + 0.5, j + 0.5);
          const double share = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
          const auto here_m = static_cast<float>((a + share * d - p).norm());
          const std::size_t at = static_cast<std::size_t>(j) * columns_ + i;
          if (here_m >= apart_m[at]) continue;
          apart_m[at] = here_m;
          nearest_[at] = static_cast<std::int16_t>(r);
        }
      }
    }
  }
}

int RowLookup::row_at(double x, double y) const {
  const double i = std::floor((x - corner_W_.x()) / cell_m_);
  const double j = std::floor((y - corner_W_.y()) / cell_m_);
  if (!(i >= 0.0 && j >= 0.0 && i < columns_ && j < rows_)) return -1;
  return nearest_[static_cast<std::size_t>(j) * columns_ + static_cast<std::size_t>(i)];
}

}  // namespace vinerow::tools
