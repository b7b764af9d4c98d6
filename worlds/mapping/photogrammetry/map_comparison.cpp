#include "worlds/mapping/photogrammetry/map_comparison.h"

#include <algorithm>
#include <cmath>

#include "engine/api/world_model.h"
#include "worlds/mapping/folder/map_frame.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;

/// Of lines that run both ways, in (-90, 90].
double wrap_line_deg(double angle_deg) {
  const double wrapped = std::remainder(angle_deg, 180.0);
  return wrapped <= -90.0 ? wrapped + 180.0 : wrapped;
}

/// Mean distance of a mapped row from a true row's line.
double apart_m(const PlantRow& mapped, const RowCurve& line) {
  const RowCurve own(seen_from_above(mapped.line_W));
  double sum_m = 0.0;
  constexpr int kPlaces = 21;
  for (int k = 0; k < kPlaces; ++k) {
    double here_m = 0.0;
    line.nearest_s_m(own.point_W(own.length_m() * (k + 0.5) / kPlaces), &here_m);
    sum_m += here_m / kPlaces;
  }
  return sum_m;
}

RowComparison compare_row(const MappedRowFigures& mapped, const RowTruth& truth) {
  RowComparison row;
  row.true_row = truth.row;
  row.mapped_row = mapped.row;
  row.bearing_deg = wrap_line_deg(mapped.bearing_deg - truth.bearing_deg);
  const auto distance_m = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - b).head<2>().norm();
  };
  row.first_m = distance_m(mapped.first_W, truth.first_W);
  row.last_m = distance_m(mapped.last_W, truth.last_W);
  // The map's row may run the other way.
  const double turned_m =
      distance_m(mapped.first_W, truth.last_W) + distance_m(mapped.last_W, truth.first_W);
  if (turned_m < row.first_m + row.last_m) {
    row.first_m = distance_m(mapped.last_W, truth.first_W);
    row.last_m = distance_m(mapped.first_W, truth.last_W);
  }
  row.length_m = mapped.length_m - truth.length_m;
  row.base_m = mapped.canopy_base_m - truth.canopy_base_m;
  row.top_m = mapped.canopy_top_m - truth.canopy_top_m;
  row.width_m = mapped.canopy_width_m - truth.canopy_width_m;
  row.volume_share = truth.volume_m3 > 0.0 ? mapped.volume_m3 / truth.volume_m3 - 1.0 : 0.0;
  row.gaps = static_cast<int>(mapped.gaps_m.size());
  row.true_gaps = static_cast<int>(truth.gaps_m.size());
  return row;
}

}  // namespace

int MapComparison::found() const {
  return static_cast<int>(
      std::count_if(rows.begin(), rows.end(), [](const auto& r) { return r.mapped_row >= 0; }));
}

double MapComparison::worst_end_m() const {
  double worst_m = 0.0;
  for (const RowComparison& row : rows) worst_m = std::max({worst_m, row.first_m, row.last_m});
  return worst_m;
}

double MapComparison::mean_end_m() const {
  double sum_m = 0.0;
  for (const RowComparison& row : rows) sum_m += row.first_m + row.last_m;
  return found() > 0 ? sum_m / (2.0 * found()) : 0.0;
}

MapComparison compare_with_truth(const CloudMap& given, const CloudTruth& truth) {
  CloudMap map = given;
  if (map.has_origin) move_map(truth.origin, map);
  MapComparison comparison;
  std::vector<bool> used(map.map.rows.size(), false);
  for (const RowTruth& row : truth.rows) {
    if (!(row.length_m > 0.0) || row.line_W.size() < 2) continue;
    const RowCurve line(seen_from_above(row.line_W));
    const double reach_m = 0.5 * (truth.spacing_m > 0.0 ? truth.spacing_m : 2.0);
    std::size_t best = map.map.rows.size();
    double best_m = reach_m;
    for (std::size_t k = 0; k < map.map.rows.size(); ++k) {
      if (used[k]) continue;
      const double here_m = apart_m(map.map.rows[k], line);
      if (here_m < best_m) best_m = here_m, best = k;
    }
    if (best == map.map.rows.size()) {
      comparison.rows.push_back({});
      comparison.rows.back().true_row = row.row;
      continue;
    }
    used[best] = true;
    comparison.rows.push_back(compare_row(map.report.rows[best], row));
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    if (!used[k]) comparison.extra_rows.push_back(map.map.rows[k].id);
  }
  comparison.bearing_deg = wrap_line_deg(map.report.bearing_deg - truth.bearing_deg);
  comparison.spacing_m = map.report.spacing_m - truth.spacing_m;
  comparison.volume_share =
      truth.volume_m3 > 0.0 ? map.report.volume_m3 / truth.volume_m3 - 1.0 : 0.0;
  comparison.seen_volume_share =
      truth.volume_m3 > 0.0 ? map.report.seen_volume_m3 / truth.volume_m3 - 1.0 : 0.0;
  return comparison;
}

}  // namespace vinerow::mapping
