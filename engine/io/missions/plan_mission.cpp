#include "engine/io/missions/plan_mission.h"

#include <algorithm>
#include <utility>

#include "engine/io/missions/mav_command.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

using Points = std::vector<PathPoint>;

double distance_to_leg_m(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
  const Eigen::Vector3d leg = b - a;
  const double length2 = leg.squaredNorm();
  const double along = length2 > 0.0 ? std::clamp((p - a).dot(leg) / length2, 0.0, 1.0) : 0.0;
  return (p - a - along * leg).norm();
}

/// Marks the points between two that are kept.
void keep_bends(const Points& points, std::size_t first, std::size_t last, double tolerance_m,
                std::vector<bool>& is_kept) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    double farthest_m = tolerance_m;
    std::size_t farthest = a;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double distance_m = distance_to_leg_m(points[i].p_W, points[a].p_W, points[b].p_W);
      if (distance_m <= farthest_m) continue;
      farthest_m = distance_m;
      farthest = i;
    }
    if (farthest == a) continue;
    is_kept[farthest] = true;
    open.push_back({a, farthest});
    open.push_back({farthest, b});
  }
}

/// Numbers of the points that become waypoints, the first of the plan among them.
std::vector<std::size_t> waypoints_of(const Points& points, double tolerance_m) {
  std::vector<bool> is_kept(points.size(), false);
  std::size_t begin = 0;
  is_kept[begin] = true;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const bool changes =
        points[i].speed_mps != points[i - 1].speed_mps ||
        (points[i].kind == PathKind::kVertical) != (points[i - 1].kind == PathKind::kVertical);
    if (!changes && i + 1 < points.size()) continue;
    is_kept[i] = true;
    keep_bends(points, begin, i, tolerance_m, is_kept);
    begin = i;
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_kept[i]) kept.push_back(i);
  }
  return kept;
}

}  // namespace

MissionFile make_plan_mission(const PlannedPath& plan, const VehicleDescription& vehicle,
                              const LocalFrame& frame, double tolerance_m) {
  MissionFile mission;
  mission.format = "plan";
  mission.rotorcraft = vehicle.rotorcraft.has_value();
  const Points& points = plan.points;
  if (points.empty()) return mission;
  mission.planned_home = frame.to_geodetic(points.front().p_W);

  const bool flies = vehicle.flies();
  const auto add = [&](int command, int map_frame, const std::array<double, 7>& params) {
    const int number = static_cast<int>(mission.items.size()) + 1;
    mission.items.push_back({command, map_frame, params, true, number});
  };
  const auto add_place = [&](int command, const Eigen::Vector3d& p_W) {
    const Geodetic place = frame.to_geodetic(p_W);
    // What drives has no altitude of its own.
    add(command, flies ? kFrameMeanSeaLevel : kFrameHome,
        {0, 0, 0, 0, deg_from_rad(place.latitude_rad), deg_from_rad(place.longitude_rad),
         flies ? place.altitude_m : 0.0});
  };

  const std::vector<std::size_t> kept = waypoints_of(points, tolerance_m);
  double speed_mps = 0.0;
  bool is_in_the_air = !flies;
  for (std::size_t k = 1; k < kept.size(); ++k) {
    const PathPoint& from = points[kept[k - 1]];
    const Eigen::Vector3d& to_W = points[kept[k]].p_W;
    if (from.speed_mps > 0.0 && from.speed_mps != speed_mps) {
      constexpr double kThroughAir = 0.0, kOverGround = 1.0, kKeepThrottle = -1.0;
      speed_mps = from.speed_mps;
      add(kDoChangeSpeed, kFrameMission,
          {vehicle.fixed_wing ? kThroughAir : kOverGround, speed_mps, kKeepThrottle, 0, 0, 0, 0});
    }
    const bool lands = vehicle.rotorcraft && from.kind == PathKind::kVertical &&
                       k + 1 == kept.size() && to_W.z() < from.p_W.z();
    if (!is_in_the_air) {
      is_in_the_air = true;
      add_place(kNavTakeOff, to_W);
      // A take-off only climbs, to the height of its item.
      if (from.kind == PathKind::kVertical || vehicle.fixed_wing) continue;
    }
    add_place(lands ? kNavLand : kNavWaypoint, to_W);
  }
  return mission;
}

}  // namespace vinerow::io
