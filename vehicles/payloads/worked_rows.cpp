#include "vehicles/payloads/worked_rows.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/api/height_field.h"
#include "engine/core/check.h"
#include "engine/math/planar.h"

namespace vinerow::vehicles {

using Eigen::Vector2d;

double RowLines::Profile::at(double along_m) const {
  const double last = static_cast<double>(ground_m.size() - 1);
  const double place = std::clamp(along_m / apart_m, 0.0, last);
  const double first = std::min(std::floor(place), last - 1.0);
  const auto i = static_cast<std::size_t>(first);
  return ground_m[i] + (place - first) * (ground_m[i + 1] - ground_m[i]);
}

RowLines::Profile RowLines::make_profile(const PlantRow& row, const Polyline& line,
                                         const HeightField& terrain) {
  constexpr double kApart_m = 1.0;
  const std::vector<double>& along_m = line.s_m();
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
  std::vector<Polyline> lines;
  for (const PlantRow& row : rows) {
    VINEROW_DEMAND(row.line_W.size() >= 2);
    const Polyline& line = lines.emplace_back(from_above(row.line_W));
    std::vector<double> ground;
    for (const Eigen::Vector3d& p : row.line_W) ground.push_back(p.z());
    ground_m_.push_back(std::move(ground));
    if (terrain != nullptr) profiles_.push_back(make_profile(row, line, *terrain));
  }
  index_ = PolylineIndex(std::move(lines));
}

RowPlace RowLines::place(int row, const Vector2d& p_W) const {
  return place_at(row, line(row).nearest(p_W), p_W);
}

RowPlace RowLines::place_at(int row, const Polyline::Nearest& found, const Vector2d& p_W) const {
  const auto index = static_cast<std::size_t>(row);
  const Polyline& line = index_.lines()[index];
  const auto segment = static_cast<std::size_t>(found.segment);
  const Vector2d &a = line.points()[segment], &b = line.points()[segment + 1];
  const std::vector<double>& along = line.s_m();
  const double length_m = along[segment + 1] - along[segment];
  RowPlace at;
  at.row = row;
  at.distance_m = found.distance_m;
  at.direction_W = (b - a) / length_m;
  at.lateral_m = cross(at.direction_W, p_W - a);
  at.along_m = along[segment] +
               (line.is_end(found) ? at.direction_W.dot(p_W - a) : found.fraction * length_m);
  if (!profiles_.empty()) {
    at.ground_m = profiles_[index].at(at.along_m);
    return at;
  }
  const std::vector<double>& ground = ground_m_[index];
  at.ground_m = ground[segment] + found.fraction * (ground[segment + 1] - ground[segment]);
  return at;
}

RowPlace RowLines::nearest(const Vector2d& p_W) const {
  const PolylineIndex::Nearest found = index_.nearest(p_W);
  VINEROW_ASSERT(found.line >= 0);
  return place_at(found.line, found, p_W);
}

AdjacentRows RowLines::adjacent(const Vector2d& p_W, double heading_rad, double reach_m,
                                double max_angle_rad, double beyond_end_m) const {
  const Vector2d ahead(std::cos(heading_rad), std::sin(heading_rad));
  AdjacentRows found;
  // Rows that are farther away than that cannot be beside the position.
  const double far_m = reach_m + std::max(0.0, beyond_end_m);
  // No heap: they go to a list of fixed length. Where more are that near, all rows are looked at.
  constexpr int kMaxNear = 16;
  std::array<int, kMaxNear> near;
  int near_count = 0;
  index_.visit_within(p_W, far_m, [&](const PolylineIndex::Nearest& at) {
    if (near_count > kMaxNear) return;
    const auto end = near.begin() + near_count;
    if (std::find(near.begin(), end, at.line) != end) return;
    if (near_count < kMaxNear) near[static_cast<std::size_t>(near_count)] = at.line;
    ++near_count;
  });
  const bool is_all = near_count > kMaxNear;
  // In the order of the rows: of two that are equally near the first counts.
  if (!is_all) std::sort(near.begin(), near.begin() + near_count);
  for (int k = 0; k < (is_all ? count() : near_count); ++k) {
    const int row = is_all ? k : near[static_cast<std::size_t>(k)];
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
