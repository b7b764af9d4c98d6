#include "worlds/mapping/photogrammetry/cloud_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/parallel.h"
#include "engine/math/angles.h"
#include "worlds/mapping/model/row_curve.h"
#include "worlds/mapping/photogrammetry/canopy_volume.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBeyondEnds_m = 3.0;
constexpr double kLineStep_m = 0.02, kEdge_m = 1e-4, kGap_m = 0.5;
constexpr double kSectionStep_m = 0.05, kVolumeGrid_m = 0.02;
constexpr double kAbove_m = 20.0;  ///< where rays down begin, above the ground

double bearing_deg_of(const Vector2d& direction) {
  const double bearing = deg_from_rad(std::atan2(direction.x(), direction.y()));
  return bearing < 0.0 ? bearing + 360.0 : bearing;
}

class RowSurvey {
 public:
  RowSurvey(const SceneQuery& scene, const WorldModel& world, const PlantRow& row)
      : scene_(scene), world_(world), line_(seen_from_above(row.line_W)), line_z_(row.line_W) {}

  const RowCurve& line() const { return line_; }

  double ground_m(const Vector2d& p) const {
    if (world_.terrain) return world_.terrain->height_m(p.x(), p.y());
    double high_m = -std::numeric_limits<double>::infinity();
    for (const Vector3d& q : line_z_) high_m = std::max(high_m, q.z());
    return scene_.ground_height_m(p.x(), p.y(), high_m + 1.0).value_or(high_m);
  }

  Vector3d on_ground_W(double s_m) const {
    const Vector2d p = line_.point_W(s_m);
    return {p.x(), p.y(), ground_m(p)};
  }

  bool has_canopy(double s_m) const {
    const Vector3d p = on_ground_W(s_m) + kAbove_m * Vector3d::UnitZ();
    return scene_.cast_ray(p, -Vector3d::UnitZ(), kAbove_m, mask_of(SurfaceClass::kCanopy))
        .has_value();
  }

  /// Stretches with canopy on the line.
  std::vector<std::pair<double, double>> stretches_m() const {
    std::vector<std::pair<double, double>> stretches;
    const auto steps =
        static_cast<int>(std::ceil((line_.length_m() + 2.0 * kBeyondEnds_m) / kLineStep_m));
    bool before = false;
    for (int k = 0; k <= steps + 1; ++k) {
      const double s_m = -kBeyondEnds_m + k * kLineStep_m;
      const bool now = k <= steps && has_canopy(s_m);
      if (now && !before) stretches.emplace_back(edge_m(s_m, s_m - kLineStep_m), 0.0);
      if (!now && before) stretches.back().second = edge_m(s_m - kLineStep_m, s_m);
      before = now;
    }
    return stretches;
  }

  /// (s, y, height above the ground on the line): along the line, to its left.
  Vector3d row_coordinates(const Vector3d& p_W) const {
    const Vector2d p = p_W.head<2>();
    double s_m = line_.nearest_s_m(p);
    Vector2d ahead = line_.direction_W(s_m), from = line_.point_W(s_m);
    // Beyond the ends the line goes on.
    const double further_m = ahead.dot(p - from);
    if (s_m <= 0.0 || s_m >= line_.length_m()) {
      s_m += further_m;
      from += further_m * ahead;
    }
    const double left_m = ahead.x() * (p - from).y() - ahead.y() * (p - from).x();
    return {s_m, left_m, p_W.z() - ground_m(from)};
  }

 private:
  double edge_m(double with_m, double without_m) const {
    while (std::abs(with_m - without_m) > kEdge_m) {
      const double middle_m = 0.5 * (with_m + without_m);
      (has_canopy(middle_m) ? with_m : without_m) = middle_m;
    }
    return with_m;
  }

  const SceneQuery& scene_;
  const WorldModel& world_;
  RowCurve line_;
  const std::vector<Vector3d>& line_z_;
};

/// Means of the canopy's cross-sections every kSectionStep_m.
void measure_sections(const RowSurvey& survey, const std::vector<CanopyTriangle>& canopy,
                      RowTruth& truth) {
  const double from_m = -kBeyondEnds_m;
  const auto count = static_cast<std::size_t>(
      std::ceil((survey.line().length_m() + 2.0 * kBeyondEnds_m) / kSectionStep_m));
  std::vector<Eigen::AlignedBox2d> sections(count);  // (left, height)
  for (const CanopyTriangle& triangle : canopy) {
    Vector3d corners[3];
    for (std::size_t k = 0; k < 3; ++k) corners[k] = survey.row_coordinates(triangle[k]);
    const auto [low, high] = std::minmax({corners[0].x(), corners[1].x(), corners[2].x()});
    const double first = std::ceil((low - from_m) / kSectionStep_m - 0.5);
    for (auto i = static_cast<std::int64_t>(std::max(first, 0.0));
         i < static_cast<std::int64_t>(count); ++i) {
      const double s_m = from_m + (static_cast<double>(i) + 0.5) * kSectionStep_m;
      if (s_m > high) break;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector3d &a = corners[k], &b = corners[(k + 1) % 3];
        if ((a.x() <= s_m) == (b.x() <= s_m)) continue;
        const Vector3d p = a + (s_m - a.x()) / (b.x() - a.x()) * (b - a);
        sections[static_cast<std::size_t>(i)].extend(Vector2d(p.y(), p.z()));
      }
    }
  }
  std::int64_t cut = 0;
  for (const Eigen::AlignedBox2d& section : sections) {
    if (section.isEmpty()) continue;
    ++cut;
    truth.canopy_base_m += section.min().y();
    truth.canopy_top_m += section.max().y();
    truth.canopy_width_m += section.sizes().x();
  }
  if (cut == 0) return;
  truth.canopy_base_m /= static_cast<double>(cut);
  truth.canopy_top_m /= static_cast<double>(cut);
  truth.canopy_width_m /= static_cast<double>(cut);
}

RowTruth measure_row(const SceneQuery& scene, const WorldModel& world, const PlantRow& row,
                     const std::vector<CanopyTriangle>& canopy) {
  const RowSurvey survey(scene, world, row);
  RowTruth truth;
  truth.row = row.id;
  truth.line_W = row.line_W;
  const auto stretches = survey.stretches_m();
  if (!stretches.empty()) {
    const double first_m = stretches.front().first, last_m = stretches.back().second;
    truth.first_W = survey.on_ground_W(first_m);
    truth.last_W = survey.on_ground_W(last_m);
    truth.length_m = last_m - first_m;
    for (std::size_t k = 0; k + 1 < stretches.size(); ++k) {
      if (stretches[k + 1].first - stretches[k].second > kGap_m) {
        truth.gaps_m.emplace_back(stretches[k].second - first_m, stretches[k + 1].first - first_m);
      }
    }
  }
  const Vector2d chord = (row.line_W.back() - row.line_W.front()).head<2>();
  truth.bearing_deg = bearing_deg_of(
      stretches.empty() ? chord : Vector2d((truth.last_W - truth.first_W).head<2>()));
  measure_sections(survey, canopy, truth);
  truth.volume_m3 = enclosed_volume_m3(canopy, chord.normalized(), kVolumeGrid_m);
  return truth;
}

/// Mean distance from points of one line to another, where that is beside it.
double spacing_m_of(const PlantRow& from, const PlantRow& to) {
  const RowCurve a(seen_from_above(from.line_W)), b(seen_from_above(to.line_W));
  constexpr int kPoints = 200;
  double sum_m = 0.0, all_m = 0.0;
  int overlaps = 0;
  for (int k = 0; k < kPoints; ++k) {
    double distance_m = 0.0;
    const double s_m = b.nearest_s_m(a.point_W(a.length_m() * (k + 0.5) / kPoints), &distance_m);
    all_m += distance_m;
    if (s_m <= 0.0 || s_m >= b.length_m()) continue;
    sum_m += distance_m;
    ++overlaps;
  }
  return overlaps > 0 ? sum_m / overlaps : all_m / kPoints;
}

}  // namespace

CloudTruth measure_truth(const SceneQuery& scene, const WorldModel& world) {
  CloudTruth truth;
  truth.world = world.name;
  truth.origin = world.origin;
  truth.boundary_W = world.rows->boundary_W;
  const std::vector<PlantRow>& rows = world.rows->rows;
  const std::vector<std::vector<CanopyTriangle>> canopy = canopy_by_row(world);
  truth.rows.resize(rows.size());
  for_chunks(rows.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
    truth.rows[k] = measure_row(scene, world, rows[k], canopy[k]);
    if (k + 1 < rows.size()) truth.rows[k].spacing_m = spacing_m_of(rows[k], rows[k + 1]);
  });
  Vector2d doubled(0, 0);  // bearings of lines: their mean is that of twice the angles
  for (const RowTruth& row : truth.rows) {
    const double twice_rad = 2.0 * rad_from_deg(row.bearing_deg);
    doubled += Vector2d(std::cos(twice_rad), std::sin(twice_rad));
    truth.volume_m3 += row.volume_m3;
    truth.spacing_m += row.spacing_m;
  }
  if (rows.size() > 1) truth.spacing_m /= static_cast<double>(rows.size() - 1);
  const double mean_deg = 0.5 * deg_from_rad(std::atan2(doubled.y(), doubled.x()));
  truth.bearing_deg = mean_deg < 0.0 ? mean_deg + 180.0 : mean_deg;
  return truth;
}

std::filesystem::path truth_file_of(std::filesystem::path cloud) {
  return cloud.replace_extension(".truth.json");
}

}  // namespace vinerow::mapping
