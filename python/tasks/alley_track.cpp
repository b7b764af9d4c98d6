#include "python/tasks/alley_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::tasks {
namespace {

std::vector<Eigen::Vector2d> plane_line(const Alley& alley, bool reversed) {
  std::vector<Eigen::Vector2d> line;
  for (const Eigen::Vector3d& point : alley.line_W) line.emplace_back(point.head<2>());
  if (reversed) std::reverse(line.begin(), line.end());
  return line;
}

}  // namespace

AlleyTrack::AlleyTrack(const RowMap& rows, int index, bool reversed)
    : line_(plane_line(rows.alleys[index], reversed)),
      width_m_(rows.alleys[index].width_m),
      index_(index),
      reversed_(reversed) {}

AlleyTrack::AlleyTrack(const RowMap& rows, const Pose& X_WB, const std::string& who) {
  if (rows.alleys.empty()) {
    throw ConfigError(fmt::format("{} needs a world with an alley; there is none in this one", who));
  }
  const Eigen::Vector2d p_W = X_WB.p.head<2>();
  int nearest = 0;
  double distance_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < rows.alleys.size(); ++i) {
    const double here_m = Polyline(plane_line(rows.alleys[i], false)).nearest(p_W).distance_m;
    if (here_m >= distance_m) continue;
    distance_m = here_m;
    nearest = static_cast<int>(i);
  }
  *this = AlleyTrack(rows, nearest, false);
  if (std::abs(place(X_WB).heading_rad) > 0.5 * kPi) *this = AlleyTrack(rows, nearest, true);
}

AlleyTrack AlleyTrack::neighbour(const RowMap& rows, int step, const std::string& who) const {
  const int count = static_cast<int>(rows.alleys.size());
  if (count < 2) {
    throw ConfigError(fmt::format("{} needs a world with two alleys; this one has {}", who, count));
  }
  int next = index_ + step;
  if (next < 0 || next >= count) next = index_ - step;
  return {rows, next, !reversed_};
}

AlleyTrack::Place AlleyTrack::place(const Pose& X_WB) const {
  const Polyline::Nearest at = line_.nearest(X_WB.p.head<2>());
  const double s_m = line_.s_m(at);
  const Eigen::Vector2d along = line_.direction_at(s_m);
  // Beyond the ends, along the extended line.
  const Eigen::Vector2d beyond = X_WB.p.head<2>() - line_.point_at(s_m);
  const Eigen::Vector2d left(-along.y(), along.x());
  return {s_m + beyond.dot(along), beyond.dot(left),
          wrap_angle(yaw_from_quaternion(X_WB.q) - std::atan2(along.y(), along.x()))};
}

}  // namespace vinerow::tasks
