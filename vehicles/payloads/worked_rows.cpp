#include "vehicles/payloads/worked_rows.h"

#include <algorithm>
#include <cmath>

#include "engine/api/height_field.h"
#include "engine/core/check.h"
#include "engine/math/planar.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector2d;

/// The grid goes this far beyond the rows: canopies and alleys beside them are inside.
constexpr double kMargin_m = 3.0;
constexpr double kCell_m = 1.0;
constexpr double kMaxCells = 100'000.0;

}  // namespace

double RowLines::Profile::at(double along_m) const {
  const double last = static_cast<double>(ground_m.size() - 1);
  const double place = std::clamp(along_m / apart_m, 0.0, last);
  const double first = std::min(std::floor(place), last - 1.0);
  const auto i = static_cast<std::size_t>(first);
  return ground_m[i] + (place - first) * (ground_m[i + 1] - ground_m[i]);
}

RowLines::Profile RowLines::make_profile(const PlantRow& row, const HeightField& terrain) const {
  constexpr double kApart_m = 1.0;
  const std::vector<double>& along_m = along_m_.back();
  const auto pieces = static_cast<std::size_t>(std::max(1.0, std::ceil(along_m.back() / kApart_m)));
  Profile profile;
  profile.apart_m = along_m.back() / static_cast<double>(pieces);
  std::size_t segment = 0;
  for (std::size_t i = 0; i <= pieces; ++i) {
    const double at_m = static_cast<double>(i) * profile.apart_m;
    while (segment + 2 < along_m.size() && along_m[segment + 1] < at_m) ++segment;
    const double share =
        std::clamp((at_m - along_m[segment]) / (along_m[segment + 1] - along_m[segment]), 0.0, 1.0);
    const Eigen::Vector3d p_W =
        row.line_W[segment] + share * (row.line_W[segment + 1] - row.line_W[segment]);
    profile.ground_m.push_back(
        terrain.contains(p_W.x(), p_W.y()) ? terrain.height_m(p_W.x(), p_W.y()) : p_W.z());
  }
  return profile;
}

RowLines::RowLines(const std::vector<PlantRow>& rows, const HeightField* terrain) {
  for (const PlantRow& row : rows) {
    VINEROW_DEMAND(row.line_W.size() >= 2);
    std::vector<Vector2d> points;
    std::vector<double> along, ground;
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& p : row.line_W) {
      const Vector2d point = p.head<2>();
      along.push_back(points.empty() ? 0.0 : along.back() + (point - points.back()).norm());
      points.push_back(point);
      ground.push_back(p.z());
      box.extend(point);
    }
    lines_.emplace_back(std::move(points));
    along_m_.push_back(std::move(along));
    ground_m_.push_back(std::move(ground));
    boxes_.push_back(box);
    if (terrain != nullptr) profiles_.push_back(make_profile(row, *terrain));
  }
  if (count() > 0) make_grid();
}

void RowLines::make_grid() {
  Eigen::AlignedBox2d all;
  for (const Eigen::AlignedBox2d& box : boxes_) all.extend(box);
  corner_W_ = all.min() - Vector2d::Constant(kMargin_m);
  const Vector2d size = all.sizes() + Vector2d::Constant(2.0 * kMargin_m);
  cell_m_ = std::max(kCell_m, std::sqrt(size.x() * size.y() / kMaxCells));
  columns_ = static_cast<int>(std::ceil(size.x() / cell_m_));
  rows_ = static_cast<int>(std::ceil(size.y() / cell_m_));
  const double diagonal_m = std::sqrt(2.0) * cell_m_;
  std::vector<PolylineDistance::Nearest> found(lines_.size());
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      const Vector2d middle = corner_W_ + cell_m_ * Vector2d(i + 0.5, j + 0.5);
      double min_m = std::numeric_limits<double>::infinity();
      for (std::size_t row = 0; row < lines_.size(); ++row) {
        // The cell before is a good place to start from.
        if (boxes_[row].exteriorDistance(middle) > min_m + diagonal_m) {
          found[row].distance_m = std::numeric_limits<double>::infinity();
          continue;
        }
        found[row] = lines_[row].nearest(middle, found[row].segment);
        min_m = std::min(min_m, found[row].distance_m);
      }
      first_.push_back(static_cast<std::int32_t>(candidates_.size()));
      // Within half a diagonal of the middle a row's distance changes by that much at most.
      for (std::size_t row = 0; row < lines_.size(); ++row) {
        if (found[row].distance_m > min_m + diagonal_m) continue;
        candidates_.push_back({static_cast<std::int32_t>(row), found[row].segment});
      }
    }
  }
  first_.push_back(static_cast<std::int32_t>(candidates_.size()));
}

RowPlace RowLines::place(int row, const Vector2d& p_W, int hint_segment) const {
  const auto index = static_cast<std::size_t>(row);
  const PolylineDistance& line = lines_[index];
  const PolylineDistance::Nearest found = line.nearest(p_W, hint_segment);
  const auto segment = static_cast<std::size_t>(found.segment);
  const Vector2d &a = line.points()[segment], &b = line.points()[segment + 1];
  const std::vector<double>& along = along_m_[index];
  const double length_m = along[segment + 1] - along[segment];
  RowPlace at;
  at.row = row;
  at.distance_m = found.distance_m;
  at.direction_W = (b - a) / length_m;
  at.lateral_m = cross(at.direction_W, p_W - a);
  const bool before = found.segment == 0 && found.fraction <= 0.0;
  const bool behind = found.segment == line.segments() - 1 && found.fraction >= 1.0;
  at.along_m =
      along[segment] + (before || behind ? at.direction_W.dot(p_W - a) : found.fraction * length_m);
  if (!profiles_.empty()) {
    at.ground_m = profiles_[index].at(at.along_m);
    return at;
  }
  const std::vector<double>& ground = ground_m_[index];
  at.ground_m = ground[segment] + found.fraction * (ground[segment + 1] - ground[segment]);
  return at;
}

RowPlace RowLines::nearest_of_all(const Vector2d& p_W) const {
  RowPlace best = place(0, p_W);
  for (int row = 1; row < count(); ++row) {
    if (boxes_[static_cast<std::size_t>(row)].exteriorDistance(p_W) >= best.distance_m) continue;
    const RowPlace at = place(row, p_W);
    if (at.distance_m < best.distance_m) best = at;
  }
  return best;
}

RowPlace RowLines::nearest(const Vector2d& p_W) const {
  VINEROW_ASSERT(count() > 0);
  const Vector2d cell = ((p_W - corner_W_) / cell_m_).array().floor();
  if (cell.x() < 0.0 || cell.y() < 0.0 || cell.x() >= columns_ || cell.y() >= rows_) {
    return nearest_of_all(p_W);
  }
  const auto index = static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(cell.x());
  RowPlace best;
  for (std::int32_t k = first_[index]; k < first_[index + 1]; ++k) {
    const Candidate& candidate = candidates_[static_cast<std::size_t>(k)];
    const RowPlace at = place(candidate.row, p_W, candidate.segment);
    if (k == first_[index] || at.distance_m < best.distance_m) best = at;
  }
  return best;
}

AdjacentRows RowLines::beside(const Vector2d& p_W, double heading_rad, double reach_m,
                              double max_angle_rad, double beyond_end_m) const {
  const Vector2d ahead(std::cos(heading_rad), std::sin(heading_rad));
  AdjacentRows found;
  for (int row = 0; row < count(); ++row) {
    const double far_m = reach_m + std::max(0.0, beyond_end_m);
    if (boxes_[static_cast<std::size_t>(row)].exteriorDistance(p_W) > far_m) continue;
    const RowPlace at = place(row, p_W);
    if (std::abs(at.lateral_m) > reach_m || at.along_m < -beyond_end_m ||
        at.along_m > length_m(row) + beyond_end_m) {
      continue;
    }
    const double along = ahead.dot(at.direction_W);
    if (std::abs(along) < std::cos(max_angle_rad)) continue;
    // Driving along the line's own direction, a vehicle to its right has the row to its left.
    const bool is_left = (along > 0.0) == (at.lateral_m < 0.0);
    std::optional<RowPlace>& side = is_left ? found.left : found.right;
    if (!side || std::abs(at.lateral_m) < std::abs(side->lateral_m)) side = at;
  }
  return found;
}

}  // namespace vinerow::vehicles
