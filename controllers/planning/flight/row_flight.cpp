#include "controllers/planning/flight/row_flight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/planning/flight/flight_path.h"
#include "controllers/planning/flight/row_flight_params.h"
#include "controllers/planning/routes/rrt_star.h"
#include "engine/api/map.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

constexpr double kShortestFlight_m = 1e-6;

/// Distance of every point of a plan along the curve of its Path.
std::vector<double> calc_distances(const PlannedPath& plan, const Path& curve) {
  std::vector<double> distances_m;
  int segment = -1;
  const PathPoint* kept = nullptr;
  for (const PathPoint& point : plan.points) {
    const bool is_new =
        kept == nullptr || (point.p_W - kept->p_W).head<2>().norm() >= kShortestFlight_m;
    if (kept != nullptr && is_new) ++segment;
    if (is_new) kept = &point;
    distances_m.push_back(segment < 0 ? 0.0 : curve.end_of(segment));
  }
  return distances_m;
}

class RowFlight final : public Planner {
 public:
  RowFlight(const RowFlightParams& params, std::unique_ptr<RowPathPlanner> path_planner,
            const PlannerContext& context)
      : params_(params),
        path_(std::move(path_planner)),
        map_(*context.map),
        scene_(context.scene) {}

  const PlanReport* report() const override { return &report_; }

  Result<PlannedPath> plan(const Pose& start) override {
    report_ = {};
    const FlightGround ground(map_, scene_, start.p.z() - params_.rest_height_m);
    if (const auto fault = find_blocked_vertical(ground, start.p.head<2>(), "take off")) {
      return Failure{*fault};
    }
    Result<PlannedPath> found = path_->plan(start.p);
    if (const PlanReport* report = path_->report()) report_ = *report;
    if (!found) return found;
    PlannedPath rows = start_at(start.p, std::move(found).value());

    PlannedPath flight;
    if (const auto fault = append_rows(ground, start.p, rows, flight)) return Failure{*fault};
    if (const auto fault = append_return(ground, start.p, flight)) return Failure{*fault};
    if (const auto fault = append_landing(ground, flight)) return Failure{*fault};
    measure(flight);
    return flight;
  }

 private:
  /// The ground planners start on the leg if the vehicle is next to it. This planner climbs to the
  /// leg if that climb is steep: the position estimate on the ground may have an error of that
  /// size, and the middle between the rows is the safest place. Else the path starts at the vehicle
  /// and joins the leg within a metre.
  PlannedPath start_at(const Eigen::Vector3d& start, PlannedPath path) const {
    constexpr double kAside_m = 1e-3, kJoin_m = 1.0, kClimbAside = 0.3;
    auto& points = path.points;
    if (points.size() < 2) return path;
    const double aside_m = (points[0].p_W - start).head<2>().norm();
    const double climb_m = params_.height_m - params_.rest_height_m;
    if (aside_m < kAside_m || aside_m < kClimbAside * climb_m) return path;
    std::size_t joint = 1;
    while (joint + 1 < points.size() && (points[joint].p_W - start).head<2>().norm() < kJoin_m &&
           points[joint].alley == points[0].alley && points[joint].curvature_per_m == 0.0) {
      ++joint;
    }
    points.erase(points.begin() + 1, points.begin() + static_cast<std::ptrdiff_t>(joint));
    const Eigen::Vector2d offset = (points[1].p_W - start).head<2>();
    points[0].p_W.head<2>() = start.head<2>();
    points[0].yaw_rad = std::atan2(offset.y(), offset.x());
    points[0].curvature_per_m = 0.0;
    return path;
  }

  /// A vertical flight needs a distance to every canopy of the vehicle's radius plus the margin.
  std::optional<std::string> find_blocked_vertical(const FlightGround& ground,
                                                   const Eigen::Vector2d& p,
                                                   const char* doing) const {
    const double needed_m = params_.radius_m + params_.route.margin_m;
    const FlightGround::Nearest nearest = ground.find_nearest_row(p);
    if (nearest.row < 0 || nearest.distance_m >= needed_m) return std::nullopt;
    const PlantRow& row = map_.rows[nearest.row];
    return fmt::format(
        "cannot {} at ({:.2f}, {:.2f}): {:.2f} m from the centre line of row {}, whose canopy is "
        "{:.2f} m wide; straight up and down needs {:.2f} m to the canopy on every side",
        doing, p.x(), p.y(), nearest.centre_m, row.id, row.canopy_width_m, needed_m);
  }

  /// Appends the take-off and the path to the end of the last row.
  std::optional<std::string> append_rows(const FlightGround& ground, const Eigen::Vector3d& start,
                                         const PlannedPath& rows, PlannedPath& flight) {
    const Path curve(rows);
    if (curve.empty()) return "the alleys to fly have no length";
    const auto ground_m = make_ground_profile(curve, ground);
    if (!ground_m) return ground_m.reason();
    const HeightProfile heights = make_row_profile(*ground_m, params_.height_m, params_.smooth_m);
    if (heights.at(0.0) <= start.z()) {
      return fmt::format(
          "cannot climb at ({:.2f}, {:.2f}): the flying height there is {:.2f} m, {:.2f} m above "
          "the map's ground, and the vehicle is at {:.2f} m already",
          start.x(), start.y(), heights.at(0.0), params_.height_m, start.z());
    }
    PathPoint take_off = rows.points.front();
    take_off.p_W = start;
    take_off.curvature_per_m = 0.0;
    take_off.kind = PathKind::kVertical;
    take_off.alley = -1;
    take_off.speed_mps = 0.0;
    flight.points.push_back(take_off);

    const std::vector<double> distances_m = calc_distances(rows, curve);
    double error_m = 0.0;
    for (std::size_t i = 0; i < rows.points.size(); ++i) {
      PathPoint point = rows.points[i];
      point.p_W.z() = heights.at(distances_m[i]);
      flight.points.push_back(point);
      const double sunk_m = ground_m->at(distances_m[i]) + params_.rest_height_m - point.p_W.z();
      if (sunk_m > 0.0) {
        return fmt::format(
            "with heights smoothed over smooth_m = {:g} m the vehicle would be {:.2g} m in the "
            "ground at ({:.2f}, {:.2f})",
            params_.smooth_m, sunk_m, point.p_W.x(), point.p_W.y());
      }
      if (point.kind != PathKind::kLeg) continue;
      const double wanted_m = ground_m->at(distances_m[i]) + params_.height_m;
      error_m = std::max(error_m, std::abs(point.p_W.z() - wanted_m));
    }
    report_.numbers["row_height_error_m"] = error_m;
    return std::nullopt;
  }

  /// Appends a vertical climb at the end of the last row and a straight path home.
  std::optional<std::string> append_return(const FlightGround& ground, const Eigen::Vector3d& start,
                                           PlannedPath& flight) {
    PathPoint& exit = flight.points.back();
    const Eigen::Vector2d from = exit.p_W.head<2>(), to = start.head<2>();
    if (!params_.returns || (to - from).norm() < kOnTheSpot_m) return std::nullopt;
    if (const auto fault = find_blocked_vertical(ground, from, "climb")) return fault;

    const PathSegment straight =
        make_straight(from, to, PathKind::kReturn, -1, params_.return_speed_mps);
    PlannedPath home = make_planned_path({straight}, params_.route.pitch_m);
    const Path curve(home);
    const auto ground_m = make_ground_profile(curve, ground);
    if (!ground_m) return "on the way home the " + ground_m.reason();
    const HeightProfile heights =
        make_return_profile(curve, *ground_m, ground, params_.return_height_m, params_.radius_m,
                            params_.return_smooth_m);
    if (heights.at(0.0) <= exit.p_W.z()) {
      return fmt::format(
          "cannot climb to the way home at ({:.2f}, {:.2f}): it starts at {:.2f} m, the rows end "
          "at {:.2f} m; return_height_m = {:.2f} m must be above height_m = {:.2f} m",
          from.x(), from.y(), heights.at(0.0), exit.p_W.z(), params_.return_height_m,
          params_.height_m);
    }
    exit.kind = PathKind::kReturn;
    exit.alley = -1;
    exit.curvature_per_m = 0.0;
    exit.yaw_rad = straight.start.yaw_rad;
    exit.speed_mps = 0.0;
    const std::vector<double> distances_m = calc_distances(home, curve);
    for (std::size_t i = 0; i < home.points.size(); ++i) {
      home.points[i].p_W.z() = heights.at(distances_m[i]);
      flight.points.push_back(home.points[i]);
    }
    report_.numbers["return_length_m"] = curve.length_m();
    report_.numbers["return_clearance_m"] = calc_clearance_m(curve, *ground_m, ground, heights);
    return std::nullopt;
  }

  /// Minimum height above the ground and above canopies directly below the path.
  static double calc_clearance_m(const Path& curve, const HeightProfile& ground_m,
                                 const FlightGround& ground, const HeightProfile& heights) {
    double min_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < heights.samples_m().size(); ++i) {
      const double at_m = static_cast<double>(i) * heights.step_m();
      double below_m = ground_m.samples_m()[i];
      if (const auto top_m = ground.canopy_top_m(curve.pose_at(at_m).p, 0.0)) {
        below_m = std::max(below_m, *top_m);
      }
      min_m = std::min(min_m, heights.samples_m()[i] - below_m);
    }
    return min_m;
  }

  std::optional<std::string> append_landing(const FlightGround& ground, PlannedPath& flight) const {
    PathPoint& above = flight.points.back();
    const Eigen::Vector2d p = above.p_W.head<2>();
    if (const auto fault = find_blocked_vertical(ground, p, "land")) return fault;
    above.kind = PathKind::kVertical;
    above.alley = -1;
    above.curvature_per_m = 0.0;
    above.speed_mps = 0.0;
    PathPoint landed = above;
    const auto ground_m = ground.ground_m(p);
    if (!ground_m) {
      return fmt::format("cannot land at ({:.2f}, {:.2f}): there is no ground", p.x(), p.y());
    }
    landed.p_W.z() = *ground_m + params_.rest_height_m;
    flight.points.push_back(landed);
    return std::nullopt;
  }

  /// Lengths of the flight: arcs in the plane, linear in height between two points.
  void measure(PlannedPath& flight) {
    double climb_m = 0.0;
    flight.length_m = 0.0;
    const Path curve(flight);
    const std::vector<double> distances_m = calc_distances(flight, curve);
    for (std::size_t i = 1; i < flight.points.size(); ++i) {
      const double rise_m = flight.points[i].p_W.z() - flight.points[i - 1].p_W.z();
      flight.length_m += std::hypot(distances_m[i] - distances_m[i - 1], rise_m);
      climb_m += std::max(rise_m, 0.0);
    }
    report_.numbers["length_m"] = flight.length_m;
    report_.numbers["climb_m"] = climb_m;
  }

  static constexpr double kOnTheSpot_m = 0.1;

  RowFlightParams params_;
  std::unique_ptr<RowPathPlanner> path_;
  const RowMap& map_;
  const SceneQuery* scene_;
  PlanReport report_;
};

}  // namespace

PartSpec row_flight_spec() {
  PartSpec spec;
  spec.name = "row_flight";
  spec.description =
      "Flight along the alleys above the map's terrain with the ground planners' turns, return "
      "above terrain and canopy, vertical take-off and landing (paper A, 4.2, fig. 20).";
  spec.parameters = row_flight_parameters();
  spec.reads = {"estimate"};
  spec.writes = {"plan", "plan_tree"};
  return spec;
}

std::unique_ptr<Planner> make_row_flight(const ParameterSet& parameters,
                                         const PlannerContext& context) {
  const std::string who = context.part + " (row_flight)";
  if (!context.vehicle_description->flies()) {
    throw ConfigError(fmt::format("{} plans flights, but vehicle type '{}' does not fly", who,
                                  context.vehicle_description->type));
  }
  const RowFlightParams params = read_row_flight_params(parameters, context, who);
  std::unique_ptr<RowPathPlanner> path_planner;
  if (!params.turns) {
    path_planner = make_grid_path(params.route,
                                  make_rrt_star_search(parameters, params.route, context), context);
  } else {
    path_planner = make_closed_form_path(params.route, *params.turns,
                                         params.radius_m + params.route.margin_m, context);
  }
  return std::make_unique<RowFlight>(params, std::move(path_planner), context);
}

}  // namespace vinerow::controllers
