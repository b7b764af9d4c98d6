#include "controllers/planning/flight/mission_route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "controllers/planning/routes/fence_paths.h"
#include "controllers/planning/routes/ground_mission.h"
#include "controllers/planning/routes/mission_items.h"
#include "controllers/planning/routes/mission_kinds.h"
#include "controllers/planning/survey/survey_heights.h"
#include "controllers/planning/survey/survey_params.h"
#include "controllers/planning/survey/survey_route.h"
#include "engine/api/file_shelf.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSamePlace_m = 1e-3;

struct MissionRouteParams {
  std::filesystem::path file;
  double climb_slope = 0.12;  ///< of a fixed wing to the first waypoint, rise over run
  double ramp_error_m = 2.0;
  bool keeps_fences = true;
  double pitch_m = 0.33;
  std::optional<double> turning_radius_m;
};

const ParameterTable<MissionRouteParams>& mission_route_table() {
  using P = MissionRouteParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .path("file", &P::file,
                "file of the mission: a .plan, a QGC WPL 110 text, or lines and points of a map "
                "(.gpkg, .kml, .kmz, .shp, .geojson)")
          .required()
          .number("climb_slope", "", &P::climb_slope, between(0.001, 10.0),
                  "slope at which fixed-wing vehicles climb to the first waypoint, rise over run; "
                  "laps are added if the path there is too short")
          .number("ramp_error_m", "m", &P::ramp_error_m, kPositive,
                  "largest deviation of ramps between places above the terrain")
          .choice("fences", &P::keeps_fences, {{"keep", true}, {"ignore", false}},
                  "keep: a fixed-wing vehicle rejects a mission whose path violates one of its "
                  "fences, others go around the fence")
          .number("waypoint_pitch_m", "m", &P::pitch_m, kPositive,
                  "on the ground straights and arcs are split into round(length / pitch) parts")
          .number("turning_radius_m", "m", &P::turning_radius_m, between(0.0, 1e3),
                  "radius of rounded corners on the ground; 0 = not rounded; default: 1.1 times "
                  "the minimum of a vehicle with axle steering, else 0");
  return table;
}

class MissionRoute final : public Planner {
 public:
  MissionRoute(const MissionRouteParams& params, const PlannerContext& context,
               const std::string& who)
      : mission_(*keep<io::MissionFile>(context.shelf, file_mark(params.file),
                                        [&] { return io::read_mission(params.file); })),
        origin_(context.origin),
        scene_(context.scene),
        vehicle_(*context.vehicle_description),
        climb_slope_(params.climb_slope),
        ramp_error_m_(params.ramp_error_m),
        keeps_fences_(params.keeps_fences),
        fences_(mission_, origin_, kFenceMargin_m) {
    winged_ = !vehicle_.rotorcraft;
    constexpr double kUsualRadius_m = 25.0;
    radius_m_ = vehicle_.min_turning_radius_m.value_or(kUsualRadius_m);
    mission_places_ = place_mission(mission_, origin_, winged_, who);
  }

  const PlanReport* report() const override { return &report_; }

  Result<PlannedPath> plan(const Pose& start) override {
    report_ = {};
    path_ = {};
    start_ = start;
    ground_ = make_ground(scene_, start.p.z() - vehicle_.height_above_ground_m);
    find_home();
    if (const auto fault = lay_path()) return Failure{*fault};
    set_mission_kinds(camera_, mission_places_.uses_camera, path_);
    if (const auto fault = check()) return Failure{*fault};
    measure();
    return path_;
  }

 private:
  /// Home is the vehicle's start: an autopilot uses that, not the position in the file.
  void find_home() {
    home_m_ = ground_(start_.p.head<2>()).value_or(start_.p.z() - vehicle_.height_above_ground_m);
  }

  Result<double> height_of(const MissionPlace& place) const {
    using Reference = MissionPlace::Reference;
    switch (place.reference) {
      case Reference::kWorld:
        return place.altitude_m;
      case Reference::kHome:
        return home_m_ + place.altitude_m;
      case Reference::kKeep:
        return path_.points.back().p_W.z();
      case Reference::kGround:
        break;
    }
    const auto ground_m = ground_(place.p_W);
    if (!ground_m) {
      return Failure{fmt::format(
          "item {} is {:g} m above the terrain at ({:.1f}, {:.1f}), where the world has no terrain",
          place.item, place.altitude_m, place.p_W.x(), place.p_W.y())};
    }
    return *ground_m + place.altitude_m;
  }

  void add(const Vector3d& p_W, PathKind kind, const MissionPlace& place) {
    if (!path_.points.empty() && (path_.points.back().p_W - p_W).norm() < kSamePlace_m) {
      path_.points.back().speed_mps = place.speed_mps;
      camera_.back() = place.camera;
      return;
    }
    PathPoint point;
    point.p_W = p_W;
    point.kind = kind;
    point.speed_mps = place.speed_mps;
    path_.points.push_back(point);
    camera_.push_back(place.camera);
    items_.push_back(place.item);
  }

  std::optional<std::string> lay_path() {
    camera_.clear();
    items_.clear();
    MissionPlace begin;
    begin.speed_mps = mission_places_.first_speed_mps;
    add(start_.p, winged_ ? PathKind::kTransit : PathKind::kVertical, begin);
    bool is_first = true;
    std::optional<MissionPlace> before;
    for (MissionPlace place : mission_places_.places) {
      using Task = MissionPlace::Task;
      if (place.task == Task::kReturn || (place.task == Task::kLand && !place.has_place)) {
        // Return home, or land at the current position, at the current height.
        const double height_m = path_.points.back().p_W.z();
        Vector3d p = path_.points.back().p_W;
        if (place.task == Task::kReturn) p << start_.p.head<2>(), height_m;
        if (path_.points.size() > 1) path_.points.back().kind = PathKind::kReturn;
        if (const auto fault = go_around_fences(p, place)) return fault;
        add(p, PathKind::kReturn, place);
        land(place);
        continue;
      }
      // A take-off without a position is where the vehicle is.
      if (!place.has_place) place.p_W = path_.points.back().p_W.head<2>();
      const auto height_m = height_of(place);
      if (!height_m) return height_m.reason();
      Vector3d p(place.p_W.x(), place.p_W.y(), *height_m);
      if (place.task == Task::kLand) p.z() = path_.points.back().p_W.z();
      if (is_first && !winged_) {
        add({start_.p.x(), start_.p.y(), p.z()}, PathKind::kTransit, place);
      } else if (is_first && !place.has_place) {
        continue;  // a fixed wing climbs on the path to the first waypoint
      } else if (is_first) {
        climb_to(p, place);
      }
      is_first = false;
      const bool follows_ground = before && place.has_place &&
                                  before->reference == MissionPlace::Reference::kGround &&
                                  place.reference == MissionPlace::Reference::kGround;
      if (follows_ground) follow_ground(*before, place);
      if (const auto fault = go_around_fences(p, place)) return fault;
      add(p, PathKind::kLeg, place);
      if (place.task == Task::kLand) land(place);
      before = place;
    }
    return path_.points.size() < 2 ? std::optional<std::string>("there is nothing to fly")
                                   : std::nullopt;
  }

  /// Bends the path of a rotorcraft around fences; its height changes linearly along the path.
  std::optional<std::string> go_around_fences(const Vector3d& p, const MissionPlace& place) {
    if (winged_ || !keeps_fences_ || fences_.empty()) return std::nullopt;
    const PathPoint from = path_.points.back();
    const auto detour = fences_.find_path(from.p_W.head<2>(), p.head<2>());
    if (!detour) return std::nullopt;  // check() names the fence
    double length_m = 0.0;
    Vector2d at = from.p_W.head<2>();
    for (const Vector2d& bend : *detour) {
      length_m += (bend - at).norm();
      at = bend;
    }
    length_m += (p.head<2>() - at).norm();
    MissionPlace bend_place = place;
    bend_place.speed_mps = from.speed_mps;
    bend_place.camera = camera_.back();
    double travelled_m = 0.0;
    at = from.p_W.head<2>();
    for (const Vector2d& bend : *detour) {
      travelled_m += (bend - at).norm();
      at = bend;
      const double height_m = from.p_W.z() + travelled_m / length_m * (p.z() - from.p_W.z());
      add({bend.x(), bend.y(), height_m}, from.kind, bend_place);
    }
    report_.numbers["fence_detours"] += detour->empty() ? 0.0 : 1.0;
    return std::nullopt;
  }

  /// Adds laps near the start if the path to the first place is too short for the climb.
  void climb_to(const Vector3d& p, const MissionPlace& place) {
    const double rise_m = p.z() - start_.p.z();
    const double needed_m = rise_m / climb_slope_, direct_m = (p - start_.p).head<2>().norm();
    if (needed_m <= direct_m) return;
    MissionPlace lap = place;
    lap.camera = false;
    double travelled_m = 0.0;
    Vector2d at = start_.p.head<2>();
    constexpr double kMore = 1.001;
    for (const Vector2d& corner : make_climb_laps(at, yaw_from_quaternion(start_.q), p.head<2>(),
                                                  kMore * needed_m, radius_m_, true)) {
      travelled_m += (corner - at).norm();
      at = corner;
      const double height_m = std::min(start_.p.z() + climb_slope_ * travelled_m, p.z());
      add({corner.x(), corner.y(), height_m}, PathKind::kTransit, lap);
    }
  }

  /// Adds points between two places above the terrain, so that ramps follow it.
  void follow_ground(const MissionPlace& from, const MissionPlace& to) {
    const auto profile = GroundProfile::make({from.p_W, to.p_W}, ground_);
    if (!profile || profile->length_m() < kSamePlace_m) return;
    std::vector<double> wanted_m;
    for (const auto& sample : profile->samples()) {
      const double share = sample.distance_m / profile->length_m();
      wanted_m.push_back(sample.ground_m + from.altitude_m +
                         share * (to.altitude_m - from.altitude_m));
    }
    const std::vector<int> points = split_ramps(*profile, wanted_m, 2, ramp_error_m_);
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const auto& sample = profile->samples()[points[i]];
      add({sample.p_W.x(), sample.p_W.y(), wanted_m[points[i]]}, PathKind::kLeg, from);
    }
  }

  /// Rotorcraft descend vertically; the landing of a fixed wing is a matter of its guidance.
  void land(const MissionPlace& place) {
    if (winged_) return;
    path_.points.back().kind = PathKind::kVertical;
    Vector3d p = path_.points.back().p_W;
    p.z() = ground_(p.head<2>()).value_or(home_m_) + vehicle_.height_above_ground_m;
    add(p, PathKind::kVertical, place);
  }

  /// Checks for a path into the ground or a violated fence.
  std::optional<std::string> check() {
    constexpr double kLook_m = 2.0;
    double min_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < path_.points.size(); ++i) {
      const PathPoint &a = path_.points[i], &b = path_.points[i + 1];
      const std::string leg =
          i == 0 || items_[i] == items_[i + 1]
              ? fmt::format("the path to item {}", items_[i + 1])
              : fmt::format("the path from item {} to item {}", items_[i], items_[i + 1]);
      if (keeps_fences_) {
        if (const auto fence =
                find_broken_fence(mission_, origin_, a.p_W.head<2>(), b.p_W.head<2>())) {
          return fmt::format("{} violates {}; 'fences: ignore' flies it nevertheless", leg, *fence);
        }
      }
      if (i == 0 || a.kind == PathKind::kVertical) continue;
      const Vector3d displacement = b.p_W - a.p_W;
      const int steps =
          std::max(1, static_cast<int>(std::ceil(displacement.head<2>().norm() / kLook_m)));
      for (int k = 0; k <= steps; ++k) {
        const Vector3d p = a.p_W + static_cast<double>(k) / steps * displacement;
        const auto ground_m = ground_(p.head<2>());
        if (!ground_m) continue;
        if (p.z() < *ground_m) {
          return fmt::format("{} goes {:.1f} m below the ground at ({:.1f}, {:.1f}){}", leg,
                             *ground_m - p.z(), p.x(), p.y(), mission_places_.height_hint);
        }
        if (a.kind != PathKind::kTransit) min_m = std::min(min_m, p.z() - *ground_m);
      }
    }
    if (std::isfinite(min_m)) report_.numbers["height_above_ground_min_m"] = min_m;
    return std::nullopt;
  }

  void measure() {
    path_.length_m = 0.0;
    for (std::size_t i = 1; i < path_.points.size(); ++i) {
      path_.length_m += (path_.points[i].p_W - path_.points[i - 1].p_W).norm();
    }
    report_.numbers["items"] = static_cast<double>(mission_.items.size());
    report_.numbers["waypoints"] = static_cast<double>(path_.points.size());
    report_.numbers["length_m"] = path_.length_m;
    report_.numbers["ignored_items"] = mission_places_.ignored_items;
    report_.numbers["loiters"] = mission_places_.loiters;
    report_.numbers["ignored_holds"] = mission_places_.ignored_holds;
  }

  const io::MissionFile mission_;
  const GeoOrigin origin_;
  const SceneQuery* scene_;
  const VehicleDescription& vehicle_;
  double climb_slope_, ramp_error_m_;
  bool keeps_fences_;
  static constexpr double kFenceMargin_m = 3.0;  // of bends in the air
  FencePaths fences_;
  bool winged_ = true;
  double radius_m_ = 25.0;
  MissionPlaces mission_places_;

  Pose start_;
  GroundHeight ground_;
  double home_m_ = 0.0;
  PlannedPath path_;
  std::vector<bool> camera_;  // at each point: on from there
  std::vector<int> items_;    // at each point: the mission's item
  PlanReport report_;
};

}  // namespace

PartSpec mission_route_spec() {
  PartSpec spec;
  spec.name = "mission_file";
  spec.description =
      "A mission from QGroundControl (.plan) or Mission Planner (QGC WPL 110), flown or driven leg "
      "by leg; docs/guides/survey.md lists the commands.";
  mission_route_table().add_to(spec);
  spec.reads = {"estimate"};
  spec.writes = {"plan"};
  return spec;
}

std::unique_ptr<Planner> make_mission_route(const ParameterSet& parameters,
                                            const PlannerContext& context) {
  const std::string who = context.part + " (mission_file)";
  const MissionRouteParams params = mission_route_table().read(parameters, who);
  const VehicleDescription& vehicle = *context.vehicle_description;
  if (vehicle.flies()) return std::make_unique<MissionRoute>(params, context, who);
  if (!vehicle.wheeled) {
    throw ConfigError(
        fmt::format("{}: vehicle type '{}' neither flies nor has wheels", who, vehicle.type));
  }
  const auto mission = keep<io::MissionFile>(context.shelf, file_mark(params.file),
                                             [&] { return io::read_mission(params.file); });
  return make_ground_mission(
      *mission, {params.keeps_fences, params.pitch_m, params.turning_radius_m}, context, who);
}

}  // namespace vinerow::controllers
