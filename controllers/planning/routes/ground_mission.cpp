#include "controllers/planning/routes/ground_mission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/lift.h"
#include "controllers/planning/routes/corner_rounding.h"
#include "controllers/planning/routes/fence_paths.h"
#include "controllers/planning/routes/mission_items.h"
#include "controllers/planning/routes/row_check.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

using Vec = Eigen::Vector2d;

constexpr double kSameSpot_m = 1e-3;

/// Distance of bends from fences, in addition to half the vehicle's width.
constexpr double kFenceMargin_m = 0.5;

double find_half_width_m(const VehicleDescription& vehicle) {
  double half_m = 0.0;
  for (const Vec& p : vehicle.outline_B()) half_m = std::max(half_m, std::abs(p.y()));
  return half_m;
}

class GroundMission final : public Planner {
 public:
  GroundMission(const io::MissionFile& mission, const GroundMissionParams& params,
                const PlannerContext& context, const std::string& who)
      : mission_(mission),
        params_(params),
        origin_(context.origin),
        map_(context.map),
        scene_(context.scene),
        vehicle_(*context.vehicle_description),
        radius_m_(find_corner_radius_m(params.turning_radius_m, *context.vehicle_description, who)),
        places_(place_mission(mission, context.origin, false, who)),
        // A rounded corner is up to R (sqrt(2) - 1) inside a right angle.
        fences_(mission, context.origin,
                kFenceMargin_m + find_half_width_m(*context.vehicle_description) +
                    (std::sqrt(2.0) - 1.0) * radius_m_) {}

  const PlanReport* report() const override { return &report_; }

  Result<PlannedPath> plan(const Pose& start) override {
    report_ = {};
    points_ = {start.p.head<2>()};
    speed_mps_.clear();
    spray_.clear();
    detours_ = 0;
    if (const auto fault = lay_path()) return Failure{*fault};
    if (points_.size() < 2) return Failure{"there is nothing to drive"};
    PlannedPath path = make_planned_path(join(), params_.pitch_m);
    if (const auto fault = check(path)) return Failure{*fault};
    measure(path);
    if (const auto fault = lift_to_ground(scene_, start.p.z(), path)) return Failure{*fault};
    return path;
  }

 private:
  std::optional<std::string> lay_path() {
    const Vec home = points_.front();
    // The file's default speeds for fixed wings and rotorcraft do not apply to a ground vehicle.
    double speed_mps = places_.first_given_mps;
    bool sprays = places_.first_sprays;
    int before = 0;
    for (const MissionPlace& place : places_.places) {
      const bool returns = place.task == MissionPlace::Task::kReturn;
      if (returns || place.has_place) {
        const Vec goal = returns ? home : place.p_W;
        if (const auto fault = go_to(goal, speed_mps, sprays, before, place.item)) return fault;
        before = place.item;
      }
      if (place.is_speed_given) speed_mps = place.speed_mps;
      sprays = place.sprays;
    }
    return std::nullopt;
  }

  std::optional<std::string> go_to(const Vec& goal, double speed_mps, bool sprays, int before,
                                   int item) {
    std::vector<Vec> waypoints;
    if (params_.keeps_fences && !fences_.empty()) {
      const auto found = fences_.find_path(points_.back(), goal);
      if (!found) {
        return fmt::format(
            "no path from {} to item {} keeps the fences: {}; 'fences: ignore' drives it "
            "nevertheless",
            before == 0 ? std::string("the start") : fmt::format("item {}", before), item,
            find_broken_fence(mission_, origin_, points_.back(), goal)
                .value_or("the gap between them is too narrow"));
      }
      waypoints = *found;
      detours_ += waypoints.empty() ? 0 : 1;
    }
    waypoints.push_back(goal);
    for (const Vec& p : waypoints) {
      if ((p - points_.back()).norm() < kSameSpot_m) continue;
      points_.push_back(p);
      speed_mps_.push_back(speed_mps);
      spray_.push_back(sprays);
    }
    return std::nullopt;
  }

  /// Straights and rounded corners; if the mission switches the sprayer, legs are where it works.
  PathSegments join() {
    PathSegments pieces;
    if (radius_m_ > 0.0) {
      RoundedPath rounded = round_corners(points_, speed_mps_, radius_m_, PathKind::kLeg);
      report_.numbers["rounded_corners"] = rounded.arcs;
      report_.numbers["loops_at_corners"] = rounded.loops;
      pieces = std::move(rounded.pieces);
    } else {
      for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
        pieces.push_back(
            make_straight(points_[i], points_[i + 1], PathKind::kLeg, -1, speed_mps_[i]));
      }
    }
    if (!places_.uses_sprayer) return pieces;
    std::size_t leg = 0;
    for (PathSegment& piece : pieces) {
      if (piece.kind != PathKind::kLeg) continue;
      if (!spray_[leg++]) piece.kind = PathKind::kTransit;
    }
    return pieces;
  }

  std::optional<std::string> check(const PlannedPath& path) const {
    if (map_ != nullptr) {
      if (auto fault = find_path_into_row(path, *map_, 0.0, &vehicle_)) return fault;
    }
    if (!params_.keeps_fences) return std::nullopt;
    for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
      const Vec from = path.points[i].p_W.head<2>(), to = path.points[i + 1].p_W.head<2>();
      const auto fence = find_broken_fence(mission_, origin_, from, to);
      if (!fence) continue;
      return fmt::format(
          "the corner near ({:.1f}, {:.1f}), rounded with {:.2f} m, violates {}; 'fences: ignore' "
          "drives it nevertheless",
          from.x(), from.y(), radius_m_, *fence);
    }
    return std::nullopt;
  }

  void measure(const PlannedPath& path) {
    report_.numbers["items"] = static_cast<double>(mission_.items.size());
    report_.numbers["waypoints"] = static_cast<double>(points_.size());
    report_.numbers["length_m"] = path.length_m;
    report_.numbers["ignored_items"] = places_.ignored_items;
    report_.numbers["loiters"] = places_.loiters;
    report_.numbers["ignored_holds"] = places_.ignored_holds;
    report_.numbers["fence_detours"] = detours_;
  }

  const io::MissionFile mission_;
  const GroundMissionParams params_;
  const GeoOrigin origin_;
  const RowMap* map_;
  const SceneQuery* scene_;
  const VehicleDescription& vehicle_;
  double radius_m_;
  MissionPlaces places_;
  FencePaths fences_;

  std::vector<Vec> points_;
  std::vector<double> speed_mps_;  // of each leg; 0: the follower's own
  std::vector<bool> spray_;        // on each leg
  int detours_ = 0;
  PlanReport report_;
};

}  // namespace

std::unique_ptr<Planner> make_ground_mission(const io::MissionFile& mission,
                                             const GroundMissionParams& params,
                                             const PlannerContext& context,
                                             const std::string& who) {
  return std::make_unique<GroundMission>(mission, params, context, who);
}

}  // namespace vinerow::controllers
