#include "controllers/planning/routes/waypoints.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "controllers/parts/paths/lift.h"
#include "controllers/parts/paths/path_pieces.h"
#include "controllers/parts/paths/verticals.h"
#include "controllers/planning/routes/corner_rounding.h"
#include "controllers/planning/routes/row_check.h"
#include "engine/api/file_shelf.h"
#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/io/geo/point_csv.h"

namespace vinerow::controllers {
namespace {

struct WaypointsParams {
  std::vector<double> x_m, y_m;
  std::optional<std::vector<double>> z_m;  ///< absent: on the ground
  std::string file;                        ///< of points, instead of x_m and y_m; empty: none
  double pitch_m = 0.33;                   ///< 0: straights are not split
  double speed_mps = 0.0;                  ///< 0: the follower's own
  double clearance_m = 0.0;
  std::optional<double> turning_radius_m;  ///< absent: from the vehicle
};

const ParameterTable<WaypointsParams>& waypoints_table() {
  using P = WaypointsParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .numbers("x_m", "m", &P::x_m, kAnyNumber, "x of the points in W (east)")
          .numbers("y_m", "m", &P::y_m, kAnyNumber, "y of the points in W (north), as many as x_m")
          .numbers("z_m", "m", &P::z_m, kAnyNumber,
                   "heights of the points in W, as many as x_m, for flying vehicles: straight in "
                   "space; default: on the ground")
          .path("file", &P::file,
                "CSV file with a line x,y in metres for each point, instead of the lists")
          .number("waypoint_pitch_m", "m", &P::pitch_m, between(0.0, 1e3),
                  "straights are split into round(length / pitch) parts; 0 = not at all")
          .number("speed_mps", "m/s", &P::speed_mps, between(0.0, 100.0),
                  "wanted speed; 0 = the follower's own")
          .number("clearance_m", "m", &P::clearance_m, between(0.0, 10.0),
                  "distance that the planned line keeps from every canopy's footprint")
          .number(
              "turning_radius_m", "m", &P::turning_radius_m, between(0.0, 1e3),
              "radius of rounded corners on the ground; 0 = not rounded; default: 1.1 times the "
              "minimum of a vehicle with axle steering, else 0: the follower turns it on the spot")
          .rule([](const P& p) -> std::string {
            if (!p.file.empty()) {
              return p.x_m.empty() && p.y_m.empty() ? "" : "has both a file and x_m or y_m";
            }
            if (p.x_m.size() == p.y_m.size()) return "";
            return fmt::format("x_m has {} numbers and y_m {}, must be as many", p.x_m.size(),
                               p.y_m.size());
          });
  return table;
}

class Waypoints final : public Planner {
 public:
  Waypoints(const WaypointsParams& params, const PlannerContext& context, const std::string& who)
      : pitch_m_(params.pitch_m),
        speed_mps_(params.speed_mps),
        clearance_m_(params.clearance_m),
        radius_m_(find_corner_radius_m(params.turning_radius_m, *context.vehicle_description, who)),
        map_(context.map),
        scene_(context.scene),
        vehicle_(*context.vehicle_description) {
    if (!params.file.empty()) {
      points_ = *keep<std::vector<Eigen::Vector2d>>(
          context.shelf, file_mark(params.file), [&] { return io::read_points_csv(params.file); });
    } else {
      for (std::size_t i = 0; i < params.x_m.size(); ++i) {
        points_.emplace_back(params.x_m[i], params.y_m[i]);
      }
    }
    if (params.z_m) {
      heights_m_ = *params.z_m;
      if (heights_m_.size() != points_.size()) {
        throw ConfigError(fmt::format("{}: z_m has {} numbers for {} points, must be as many", who,
                                      heights_m_.size(), points_.size()));
      }
      if (points_.size() < 2) throw ConfigError(too_few(who));
      return;
    }
    for (std::size_t i = 1; i < points_.size();) {
      const bool is_same = (points_[i] - points_[i - 1]).norm() < 1e-6;
      if (is_same) {
        points_.erase(points_.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
    if (points_.size() < 2) throw ConfigError(too_few(who));
  }

  const PlanReport* report() const override { return &report_; }

  Result<PlannedPath> plan(const Pose& start) override {
    report_ = {};
    if (!heights_m_.empty()) return plan_flight(start);
    PlannedPath path = make_planned_path(lay_path(), pitch_m_ > 0.0 ? pitch_m_ : kNotSplit_m);
    if (map_ != nullptr) {
      if (const auto fault = find_path_into_row(path, *map_, clearance_m_, &vehicle_))
        return Failure{*fault};
    }
    if (const auto fault = lift_to_ground(scene_, start.p.z(), path)) return Failure{*fault};
    return path;
  }

 private:
  static constexpr double kNotSplit_m = 1e9;

  PathSegments lay_path() {
    const std::vector<double> speed_mps(points_.size() - 1, speed_mps_);
    if (radius_m_ > 0.0) {
      RoundedPath rounded = round_corners(points_, speed_mps, radius_m_, PathKind::kLeg);
      report_.numbers["rounded_corners"] = rounded.arcs;
      report_.numbers["loops_at_corners"] = rounded.loops;
      return std::move(rounded.pieces);
    }
    PathSegments pieces;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      pieces.push_back(make_straight(points_[i], points_[i + 1], PathKind::kLeg, -1, speed_mps_));
    }
    return pieces;
  }

  static std::string too_few(const std::string& who) {
    return fmt::format("{}: needs at least two different points, from x_m and y_m or from a file",
                       who);
  }

  /// Of a point below the ground; negative above it.
  double calc_depth_m(const Eigen::Vector3d& p_W) const {
    if (scene_ == nullptr) return -1.0;
    const auto ground_m = scene_->ground_height_m(p_W.x(), p_W.y(), kAboveEverything_m);
    return ground_m ? *ground_m - p_W.z() : -1.0;
  }

  /// Straights from point to point in space; the ground between them is ignored.
  Result<PlannedPath> plan_flight(const Pose& start) const {
    PlannedPath path;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      PathPoint point;
      point.p_W << points_[i], heights_m_[i];
      const double below_m = calc_depth_m(point.p_W);
      if (below_m > 0.0) {
        return Failure{fmt::format("point {} of {} is {:.2f} m below the ground: z_m = {:g}", i + 1,
                                   points_.size(), below_m, heights_m_[i])};
      }
      point.speed_mps = speed_mps_;
      path.points.push_back(point);
      if (i == 0) continue;
      const Eigen::Vector3d displacement_W = point.p_W - path.points[i - 1].p_W;
      path.length_m += displacement_W.norm();
      path.points[i - 1].yaw_rad = path.points[i].yaw_rad =
          std::atan2(displacement_W.y(), displacement_W.x());
    }
    if (vehicle_.rotorcraft) add_take_off(start.p, path);
    return path;
  }

  double pitch_m_, speed_mps_, clearance_m_, radius_m_;
  PlanReport report_;
  const RowMap* map_;
  const SceneQuery* scene_;
  const VehicleDescription& vehicle_;
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> heights_m_;  ///< empty: on the ground
};

}  // namespace

PartSpec waypoints_spec() {
  PartSpec spec;
  spec.name = "waypoints";
  spec.description =
      "Path of straights between points from the scenario or a CSV file, on the ground or in the "
      "air.";
  waypoints_table().add_to(spec);
  spec.reads = {"estimate"};
  spec.writes = {"plan"};
  return spec;
}

std::unique_ptr<Planner> make_waypoints(const ParameterSet& parameters,
                                        const PlannerContext& context) {
  const std::string who = context.part + " (waypoints)";
  return std::make_unique<Waypoints>(waypoints_table().read(parameters, who), context, who);
}

}  // namespace vinerow::controllers
