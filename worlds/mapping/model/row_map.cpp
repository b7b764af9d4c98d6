#include "worlds/mapping/model/row_map.h"

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/core/check.h"
#include "engine/math/planar.h"

namespace vinerow::mapping {
namespace {

Eigen::Vector2d chord(const RowCurve& row) {
  return row.points_W().back() - row.points_W().front();
}

Eigen::Vector2d mean_direction(const std::vector<RowCurve>& rows) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const RowCurve& row : rows) sum += chord(row);
  return sum.normalized();
}

std::vector<Eigen::Vector3d> lift(const std::vector<Eigen::Vector2d>& line,
                                  const GroundHeight& ground) {
  std::vector<Eigen::Vector3d> lifted;
  for (const Eigen::Vector2d& p : line) lifted.emplace_back(p.x(), p.y(), ground(p.x(), p.y()));
  return lifted;
}

}  // namespace

std::vector<RowCurve> order_rows(std::vector<RowCurve> rows) {
  VINEROW_DEMAND(!rows.empty());
  const Eigen::Vector2d reference = chord(rows.front());
  for (RowCurve& row : rows) {
    if (chord(row).dot(reference) >= 0.0) continue;
    std::vector<Eigen::Vector2d> points = row.points_W();
    std::reverse(points.begin(), points.end());
    row = RowCurve(std::move(points));
  }
  const Eigen::Vector2d across = left_of(mean_direction(rows));
  const auto offset_m = [&](const RowCurve& row) {
    return across.dot(row.point_W(0.5 * row.length_m()));
  };
  const double first_m = offset_m(rows.front());
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const RowCurve& a, const RowCurve& b) { return offset_m(a) < offset_m(b); });
  const double middle_m = 0.5 * (offset_m(rows.front()) + offset_m(rows.back()));
  if (first_m > middle_m) std::reverse(rows.begin(), rows.end());
  return rows;
}

std::vector<Eigen::Vector2d> middle_line(const RowCurve& left, const RowCurve& right) {
  const std::size_t count = std::max(left.points_W().size(), right.points_W().size());
  std::vector<Eigen::Vector2d> line;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    line.push_back(
        0.5 * (left.point_W(share * left.length_m()) + right.point_W(share * right.length_m())));
  }
  return line;
}

std::vector<Eigen::Vector2d> parcel_boundary(const std::vector<RowCurve>& rows, double along_m,
                                             double across_m) {
  const Eigen::Vector2d x = mean_direction(rows), y = left_of(x);
  Eigen::AlignedBox2d box;
  for (const RowCurve& row : rows) {
    for (const Eigen::Vector2d& p : row.points_W()) box.extend(Eigen::Vector2d(x.dot(p), y.dot(p)));
  }
  const Eigen::Vector2d margin(along_m, across_m);
  const Eigen::Vector2d low = box.min() - margin, high = box.max() + margin;
  return {low.x() * x + low.y() * y, high.x() * x + low.y() * y, high.x() * x + high.y() * y,
          low.x() * x + high.y() * y};
}

Eigen::AlignedBox2d box_around(const std::vector<Eigen::Vector2d>& polygon_W) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : polygon_W) box.extend(p);
  return box;
}

RowMap make_row_map(const std::vector<RowCurve>& rows, const GroundHeight& ground,
                    const CanopySize& canopy, std::vector<Eigen::Vector2d> boundary_W) {
  RowMap map;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    PlantRow row;
    row.id = static_cast<int>(i);
    row.line_W = lift(rows[i].points_W(), ground);
    row.canopy_width_m = canopy.width_m;
    row.canopy_base_m = canopy.base_m;
    row.canopy_top_m = canopy.top_m;
    map.rows.push_back(std::move(row));
    if (i == 0) continue;
    Alley alley;
    alley.id = static_cast<int>(i) - 1;
    alley.line_W = lift(middle_line(rows[i - 1], rows[i]), ground);
    // Pitch at mid length, at right angles to the alley.
    const Eigen::Vector2d a = rows[i - 1].point_W(0.5 * rows[i - 1].length_m());
    const Eigen::Vector2d b = rows[i].point_W(0.5 * rows[i].length_m());
    const Eigen::Vector2d along =
        (alley.line_W.back() - alley.line_W.front()).head<2>().normalized();
    alley.width_m = std::abs(left_of(along).dot(b - a));
    map.alleys.push_back(std::move(alley));
  }
  map.boundary_W = std::move(boundary_W);
  return map;
}

}  // namespace vinerow::mapping
