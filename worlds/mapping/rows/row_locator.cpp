#include "worlds/mapping/rows/row_locator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"

namespace vinerow::mapping {
namespace {

constexpr double kSquare_m = 0.5;
constexpr double kLocatedBeyond_m = 1.0;

}  // namespace

RowLocator::RowLocator(const std::vector<RowCurve>& lines, double reach_m)
    : RowLocator(lines, std::vector<double>(lines.size(), reach_m)) {}

RowLocator::RowLocator(const std::vector<RowCurve>& lines, const std::vector<double>& reach_m)
    : lines_(lines), reach_m_(reach_m) {
  VINEROW_DEMAND(lines.size() < 32767 && reach_m.size() == lines.size());
  Eigen::AlignedBox2d box;
  for (const RowCurve& line : lines_) {
    VINEROW_DEMAND(line.points_W().size() < 32767);
    for (const Eigen::Vector2d& p : line.points_W()) box.extend(p);
  }
  if (lines_.empty()) return;
  const double margin_m =
      *std::max_element(reach_m.begin(), reach_m.end()) + kLocatedBeyond_m + 2.0 * kSquare_m;
  corner_ = box.min() - Eigen::Vector2d::Constant(margin_m);
  const Eigen::Vector2d size = box.sizes() + Eigen::Vector2d::Constant(2.0 * margin_m);
  columns_ = static_cast<int>(size.x() / kSquare_m) + 1;
  rows_ = static_cast<int>(size.y() / kSquare_m) + 1;
  squares_.resize(static_cast<std::size_t>(columns_) * rows_);
  std::vector<float> nearest(squares_.size(), std::numeric_limits<float>::infinity());
  const double half_diagonal_m = 0.71 * kSquare_m;
  for (std::size_t r = 0; r < lines_.size(); ++r) {
    const RowCurve& line = lines_[r];
    for (std::size_t k = 0; k < line.directions_W().size(); ++k) {
      // The squares around the segment, a little longer at the row's ends.
      const Eigen::Vector2d u = line.directions_W()[k];
      const Eigen::Vector2d a = line.points_W()[k] - (k == 0 ? kLocatedBeyond_m : 0.0) * u;
      const Eigen::Vector2d b = line.points_W()[k + 1] +
                                (k + 1 == line.directions_W().size() ? kLocatedBeyond_m : 0.0) * u;
      const double length_m = (b - a).norm();
      const double far_m = reach_m[r] + half_diagonal_m;
      // Long segments of straight rows are walked along in short pieces: their box would be huge.
      const int pieces = std::max(1, static_cast<int>(std::ceil(length_m / 4.0)));
      for (int piece = 0; piece < pieces; ++piece) {
        Eigen::AlignedBox2d part;
        part.extend(a + u * (length_m * piece / pieces));
        part.extend(a + u * (length_m * (piece + 1) / pieces));
        const Eigen::Vector2d low =
            (part.min() - corner_ - Eigen::Vector2d::Constant(far_m)) / kSquare_m;
        const Eigen::Vector2d high =
            (part.max() - corner_ + Eigen::Vector2d::Constant(far_m)) / kSquare_m;
        for (int j = std::max(0, static_cast<int>(low.y()));
             j <= std::min<int>(rows_ - 1, static_cast<int>(high.y())); ++j) {
          for (int i = std::max(0, static_cast<int>(low.x()));
               i <= std::min<int>(columns_ - 1, static_cast<int>(high.x())); ++i) {
            const Eigen::Vector2d middle = corner_ + kSquare_m * Eigen::Vector2d(i + 0.5, j + 0.5);
            const double along_m = std::clamp((middle - a).dot(u), 0.0, length_m);
            const auto apart_m = static_cast<float>((a + along_m * u - middle).norm());
            const std::size_t at = static_cast<std::size_t>(j) * columns_ + i;
            if (apart_m > far_m || apart_m >= nearest[at]) continue;
            nearest[at] = apart_m;
            squares_[at] = {static_cast<std::int16_t>(r), static_cast<std::int16_t>(k)};
          }
        }
      }
    }
  }
}

RowPlace RowLocator::locate(double x, double y) const {
  const double u = (x - corner_.x()) / kSquare_m, v = (y - corner_.y()) / kSquare_m;
  if (!(u >= 0.0 && v >= 0.0 && u < columns_ && v < rows_)) return {};
  const Square square =
      squares_[static_cast<std::size_t>(v) * columns_ + static_cast<std::size_t>(u)];
  if (square.row < 0) return {};
  const RowCurve& line = lines_[static_cast<std::size_t>(square.row)];
  const double reach_of_line_m = reach_m_[static_cast<std::size_t>(square.row)];
  const int last = static_cast<int>(line.directions_W().size()) - 1;
  const Eigen::Vector2d p(x, y);
  RowPlace place;
  double best = std::numeric_limits<double>::infinity();
  for (int k = std::max(0, square.segment - 1); k <= std::min(last, square.segment + 1); ++k) {
    const auto n = static_cast<std::size_t>(k);
    const Eigen::Vector2d& d = line.directions_W()[n];
    const Eigen::Vector2d from = p - line.points_W()[n];
    const double length_m = line.s_m()[n + 1] - line.s_m()[n];
    double along_m = from.dot(d);
    if (k > 0) along_m = std::max(along_m, 0.0);
    if (k < last) along_m = std::min(along_m, length_m);
    const double square_m2 = (from - along_m * d).squaredNorm();
    if (square_m2 >= best) continue;
    best = square_m2;
    const double side = d.x() * from.y() - d.y() * from.x();
    place.row = square.row;
    place.s_m = static_cast<float>(line.s_m()[n] + along_m);
    place.y_m = static_cast<float>(std::copysign(std::sqrt(square_m2), side));
  }
  return best <= reach_of_line_m * reach_of_line_m ? place : RowPlace{};
}

}  // namespace vinerow::mapping
