#include "controllers/planning/routes/route_clearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/math/polyline.h"

namespace vinerow::controllers {
namespace {

/// The row whose canopy covers a point, or nullptr.
const PlantRow* find_row_at(const RowMap& map, const Eigen::Vector2d& p, double& distance_m) {
  for (const PlantRow& row : map.rows) {
    for (std::size_t i = 0; i + 1 < row.line_W.size(); ++i) {
      distance_m =
          distance_to_segment_m<2>(p, row.line_W[i].head<2>(), row.line_W[i + 1].head<2>());
      if (distance_m < 0.5 * row.canopy_width_m) return &row;
    }
  }
  return nullptr;
}

}  // namespace

bool RouteClearance::is_free(const std::vector<PathSegment>& pieces) const {
  return std::all_of(pieces.begin(), pieces.end(), [&](const PathSegment& piece) {
    return footprint_.is_free_along(piece.start, piece.length_m, piece.curvature_per_m, step_m_);
  });
}

double RouteClearance::clearance_m(const PathSegment& piece) const {
  return footprint_.clearance_along_m(piece.start, piece.length_m, piece.curvature_per_m, step_m_);
}

std::string RouteClearance::describe(const Pose2& pose) const {
  double distance_m = 0.0;
  if (const PlantRow* row = find_row_at(map_, pose.p, distance_m)) {
    return fmt::format(
        "{} is in a row: {:.2f} m from the centre line of row {}, whose canopy is {:.2f} m wide",
        to_string(pose), distance_m, row->id, row->canopy_width_m);
  }
  return describe_clearance(pose, footprint_);
}

std::optional<std::string> RouteClearance::find_blocked_end(const RouteLeg& leg) const {
  for (const auto& [end, name] : {std::pair(leg.entry(), "entrance"), {leg.exit(), "exit"}}) {
    if (footprint_.is_free(end)) continue;
    return fmt::format("{} of alley {} blocked: {}", name, leg.alley, describe(end));
  }
  return std::nullopt;
}

std::optional<std::string> RouteClearance::find_blocked(const RouteLeg& leg) const {
  if (auto end = find_blocked_end(leg)) return end;
  std::vector<PathSegment> pieces;
  append_leg(leg, 0.0, pieces);
  for (const PathSegment& piece : pieces) {
    const int parts = static_cast<int>(std::ceil(piece.length_m / step_m_));
    for (int i = 0; i <= parts; ++i) {
      const Pose2 pose = piece.at(piece.length_m * i / parts);
      if (footprint_.is_free(pose)) continue;
      return fmt::format("the leg in alley {} is blocked: {}", leg.alley, describe(pose));
    }
  }
  return std::nullopt;
}

}  // namespace vinerow::controllers
