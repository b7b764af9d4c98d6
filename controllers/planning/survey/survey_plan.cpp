#include "controllers/planning/survey/survey_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/pose2.h"
#include "controllers/planning/survey/survey_climb.h"
#include "controllers/planning/survey/survey_forecast.h"
#include "controllers/planning/survey/survey_order.h"
#include "controllers/planning/survey/survey_route.h"
#include "engine/io/geo/area_file.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;

constexpr double kM2PerHa = 1e4;
constexpr double kRotorAcceleration_mps2 = 2.0;  // at corners

class SurveyPlanner {
 public:
  SurveyPlanner(const SurveyRequest& request, const Pose& start_W, const GroundHeight& ground)
      : request_(request), start_W_(start_W), ground_(ground) {}

  Result<SurveyPlan> plan() {
    plan_.rotorcraft = request_.rotorcraft;
    const bool is_sound = !io::find_area_fault(request_.polygon_W);
    if (request_.lane_yaw_rad) {
      plan_.frame.yaw_rad = *request_.lane_yaw_rad;
    } else if (is_sound) {
      plan_.frame.yaw_rad = choose_lane_yaw_rad(request_.polygon_W);
    }
    if (const auto fault = find_survey_fault(request_, plan_.frame.yaw_rad)) return Failure{*fault};
    if (const auto fault = find_corner_outside(request_.polygon_W, ground_)) return Failure{*fault};
    if (const auto fault = find_size_fault()) return Failure{*fault};
    cut();
    route();
    if (const auto fault = climb()) return Failure{*fault};
    fly();
    take_pictures();
    std::optional<Vector2d> bare_W;
    const SurveyForecast forecast = forecast_survey(request_, plan_.shots, ground_, bare_W);
    if (bare_W) {
      return Failure{
          fmt::format("the polygon has no terrain at ({:.1f}, {:.1f})", bare_W->x(), bare_W->y())};
    }
    set("covered_share", forecast.covered_share);
    set("views_min", forecast.min_views);
    set("views_mean", forecast.mean_views);
    return std::move(plan_);
  }

 private:
  void set(const char* name, double value) { plan_.numbers[name] = value; }

  LaneNeeds lane_needs() const {
    const SurveyCamera& camera = request_.camera;
    const double height_m = request_.height_m;
    LaneNeeds needs;
    needs.footprint_width_m = camera.footprint_width_m(height_m);
    needs.footprint_length_m = camera.footprint_length_m(height_m);
    needs.spacing_m = (1.0 - request_.side_overlap) * needs.footprint_width_m;
    needs.end_margin = request_.end_margin;
    needs.edge_margin = request_.edge_margin;
    return needs;
  }

  /// Limit on the number of lanes and pictures, checked before any lane is cut.
  std::optional<std::string> find_size_fault() const {
    constexpr double kMaxLanes = 1'000.0, kMaxPictures = 200'000.0;
    const LaneNeeds needs = lane_needs();
    Vector2d low = plan_.frame.to_lane(request_.polygon_W.front()), high = low;
    for (const Vector2d& p : request_.polygon_W) {
      low = low.cwiseMin(plan_.frame.to_lane(p));
      high = high.cwiseMax(plan_.frame.to_lane(p));
    }
    const double lanes = (high.y() - low.y()) / needs.spacing_m + 1.0;
    const double pictures = lanes * (high.x() - low.x()) /
                            ((1.0 - request_.forward_overlap) * needs.footprint_length_m);
    if (lanes <= kMaxLanes && pictures <= kMaxPictures) return std::nullopt;
    return fmt::format(
        "{:.0f} m x {:.0f} m at {:.4g} m would take {:.3g} lanes {:.3g} m apart and {:.3g} "
        "pictures, must be at most {:.0f} lanes and {:.0f} pictures: fly higher or survey less",
        high.x() - low.x(), high.y() - low.y(), request_.height_m, lanes, needs.spacing_m, pictures,
        kMaxLanes, kMaxPictures);
  }

  void cut() {
    const SurveyCamera& camera = request_.camera;
    const double height_m = request_.height_m;
    const LaneNeeds needs = lane_needs();
    plan_.lanes = cut_lanes(request_.polygon_W, plan_.frame, needs);

    // Often enough for the lowest ramps, but not more often than the camera can.
    const Vector2d along = plan_.frame.along();
    const double up_mps = *calc_ground_speed_mps(request_.speed_mps, request_.wind_W, along);
    const double down_mps = *calc_ground_speed_mps(request_.speed_mps, request_.wind_W, -along);
    const double fastest_mps = std::max(up_mps, down_mps);
    const double lowest_m = std::max(0.5 * height_m, height_m - request_.ramp_error_m);
    plan_.photo_distance_m =
        std::max((1.0 - request_.forward_overlap) * camera.footprint_length_m(lowest_m),
                 fastest_mps / camera.max_rate_Hz);
    for (SurveyLane& lane : plan_.lanes) {
      for (LaneSegment& piece : lane.pieces) {
        const double length_m = piece.to_m - piece.from_m;
        const double whole_m =
            plan_.photo_distance_m * std::ceil(length_m / plan_.photo_distance_m - 1e-9);
        piece.from_m -= 0.5 * (whole_m - length_m);
        piece.to_m += 0.5 * (whole_m - length_m);
      }
    }
    const double spacing_m = plan_.lanes.size() > 1
                                 ? plan_.lanes[1].across_m - plan_.lanes[0].across_m
                                 : needs.footprint_width_m;
    set("area_ha", std::abs(signed_area_m2(request_.polygon_W)) / kM2PerHa);
    set("lanes", static_cast<double>(plan_.lanes.size()));
    set("lane_spacing_m", spacing_m);
    const double bearing_deg = 90.0 - deg_from_rad(plan_.frame.yaw_rad);
    set("lane_bearing_deg", std::fmod(bearing_deg + 360.0, 180.0));
    set("height_m", height_m);
    set("footprint_width_m", needs.footprint_width_m);
    set("footprint_length_m", needs.footprint_length_m);
    set("gsd_mm", kMmPerM * camera.gsd_m(height_m));
    set("side_overlap", camera.side_overlap(height_m, spacing_m));
    set("forward_overlap", camera.forward_overlap(height_m, plan_.photo_distance_m));
    set("photo_distance_m", plan_.photo_distance_m);
    set("photo_interval_s", plan_.photo_distance_m / fastest_mps);
    set("ground_speed_max_mps", fastest_mps);
    set("ground_speed_min_mps", std::min(up_mps, down_mps));
  }

  void route() {
    task_.start_W = start_W_.p.head<2>();
    task_.returns = request_.returns;
    task_.turn_radius_m = calc_turn_radius_m(request_);
    // Roll-in and roll-out take about three quarters of a second (paper A's reference, section 2:
    // phi / 2 phi' + tau), settling on the line about one second.
    constexpr double kSettle_s = 2.0;
    // A multirotor stops at corners: v^2 / 2a until it reaches the speed of the lane.
    const double usual_m =
        request_.rotorcraft
            ? 0.5 * request_.speed_mps * request_.speed_mps / kRotorAcceleration_mps2
            : task_.turn_radius_m + kSettle_s * (request_.speed_mps + request_.wind_W.norm());
    task_.run_out_m = request_.run_out_m.value_or(usual_m);
    OrderTask order_task;
    for (const SurveyLane& lane : plan_.lanes) {
      order_task.lanes.push_back(
          {lane.across_m, lane.low_m() - task_.run_out_m, lane.high_m() + task_.run_out_m});
    }
    order_task.turn_radius_m = task_.turn_radius_m;
    order_task.start = order_task.home = plan_.frame.to_lane(task_.start_W);
    const LaneOrder order = request_.order == SurveyRequest::Order::kSnake
                                ? order_lanes_as_snake(order_task)
                                : order_lanes(order_task);
    plan_.order = order.lanes;
    route_ = make_survey_route(task_, plan_.frame, plan_.lanes, order);
    set("turn_radius_m", task_.turn_radius_m);
    set("run_out_m", task_.run_out_m);
    set("wide_turns", route_.wide_turns);
    int skipped = 0;
    for (std::size_t i = 1; i < plan_.order.size(); ++i) {
      skipped += std::abs(plan_.order[i] - plan_.order[i - 1]) > 1;
    }
    set("skipping_turns", skipped);
    set("corners", 2.0 * static_cast<double>(plan_.lanes.size()) + 2.0 * route_.wide_turns);
  }

  std::optional<std::string> climb() {
    auto climb = climb_to_first_lane(request_, start_W_, route_, ground_);
    if (!climb) return climb.reason();
    climb_ = std::move(climb).value();
    route_ = climb_.route;
    wanted_m_ = climb_.wanted_m;
    profile_ = &climb_.profile;
    climb_m_ = climb_.length_m;
    set("climb_way_m", climb_m_);
    set("climb_clearance_min_m", climb_.clearance_m);
    return std::nullopt;
  }

  /// Sets waypoints, lengths and times.
  void fly() {
    const auto& samples = profile_->samples();
    const std::vector<int> split =
        split_ramps(*profile_, wanted_m_, route_.points.size(), request_.ramp_error_m);
    std::size_t leg = 0;
    double time_s = 0.0, slope = 0.0;
    std::map<PathKind, double> lengths_m;
    ramp_m_.assign(samples.size(), 0.0);
    for (std::size_t k = 0; k < split.size(); ++k) {
      const int at = split[k];
      while (leg + 2 < route_.points.size() && at >= profile_->at_point(leg + 1)) ++leg;
      const Vector2d displacement = route_.points[leg + 1].p_W - route_.points[leg].p_W;
      PathPoint point;
      point.p_W << samples[at].p_W, wanted_m_[at];
      point.yaw_rad = std::atan2(displacement.y(), displacement.x());
      point.speed_mps = request_.speed_mps;
      point.kind = route_.points[leg].kind;
      point.alley = route_.points[leg].lane;
      if (k + 1 == split.size()) point.kind = route_.points.back().kind, point.alley = -1;
      plan_.path.points.push_back(point);
      ramp_m_[at] = wanted_m_[at];
      if (k + 1 == split.size()) break;
      const int next = split[k + 1];
      const double length_m = samples[next].distance_m - samples[at].distance_m;
      const double rise_m = wanted_m_[next] - wanted_m_[at];
      for (int i = at; i < next; ++i) {
        const double share = (samples[i].distance_m - samples[at].distance_m) / length_m;
        ramp_m_[i] = wanted_m_[at] + share * rise_m;
      }
      lengths_m[point.kind] += length_m;
      plan_.path.length_m += std::hypot(length_m, rise_m);
      const auto speed_mps =
          calc_ground_speed_mps(request_.speed_mps, request_.wind_W, displacement.normalized());
      time_s += length_m / speed_mps.value_or(request_.speed_mps);
      if (samples[at].distance_m >= climb_m_) slope = std::max(slope, std::abs(rise_m / length_m));
    }
    // A stop takes v / a longer than passing at speed v.
    if (request_.rotorcraft) {
      time_s +=
          static_cast<double>(route_.points.size()) * request_.speed_mps / kRotorAcceleration_mps2;
    }
    set("waypoints", static_cast<double>(split.size()));
    set("ramp_points", static_cast<double>(split.size() - route_.points.size()));
    set("length_m", plan_.path.length_m);
    set("lane_way_m", lengths_m[PathKind::kLeg]);
    set("turn_way_m", lengths_m[PathKind::kTurn]);
    set("flight_time_s", time_s);
    set("slope_max", slope);
    measure_heights();
  }

  void measure_heights() {
    const auto& samples = profile_->samples();
    double error_m = 0.0, low_m = 1e9, high_m = -1e9, above_m = 0.0;
    for (std::size_t leg = 0; leg + 1 < route_.points.size(); ++leg) {
      for (int i = profile_->at_point(leg); i <= profile_->at_point(leg + 1); ++i) {
        if (samples[i].distance_m < climb_m_) continue;
        const double height_m = ramp_m_[i] - samples[i].ground_m;
        error_m = std::max(error_m, std::abs(ramp_m_[i] - wanted_m_[i]));
        if (route_.points[leg].kind != PathKind::kLeg) continue;
        above_m = std::max(above_m, wanted_m_[i] - samples[i].ground_m - request_.height_m);
        low_m = std::min(low_m, height_m);
        high_m = std::max(high_m, height_m);
      }
    }
    const SurveyCamera& camera = request_.camera;
    set("ramp_error_m", error_m);
    set("steep_terrain_extra_m", above_m);
    set("height_above_ground_min_m", low_m);
    set("height_above_ground_max_m", high_m);
    set("gsd_min_mm", kMmPerM * camera.gsd_m(low_m));
    set("gsd_max_mm", kMmPerM * camera.gsd_m(high_m));
    set("forward_overlap_min", camera.forward_overlap(low_m, plan_.photo_distance_m));
    set("side_overlap_min", camera.side_overlap(low_m, plan_.numbers["lane_spacing_m"]));
    set("samples_beyond_terrain", profile_->beyond_terrain());
  }

  void take_pictures() {
    const auto& samples = profile_->samples();
    for (std::size_t leg = 0; leg + 1 < route_.points.size(); ++leg) {
      if (route_.points[leg].kind != PathKind::kLeg) continue;
      const Vector2d from = route_.points[leg].p_W,
                     displacement = route_.points[leg + 1].p_W - from;
      const int count = static_cast<int>(std::lround(displacement.norm() / plan_.photo_distance_m));
      int i = profile_->at_point(leg);
      const double start_m = samples[i].distance_m;
      for (int k = 0; k <= count; ++k) {
        const double at_m = start_m + k * plan_.photo_distance_m;
        while (i + 1 < profile_->at_point(leg + 1) && samples[i + 1].distance_m < at_m) ++i;
        const double share = std::clamp(
            (at_m - samples[i].distance_m) / (samples[i + 1].distance_m - samples[i].distance_m),
            0.0, 1.0);
        const auto mix = [&](double a, double b) { return a + share * (b - a); };
        SurveyShot shot;
        shot.p_W << from + k * plan_.photo_distance_m * displacement.normalized(),
            mix(ramp_m_[i], ramp_m_[i + 1]);
        shot.yaw_rad = std::atan2(displacement.y(), displacement.x());
        shot.height_m = shot.p_W.z() - mix(samples[i].ground_m, samples[i + 1].ground_m);
        shot.lane = route_.points[leg].lane;
        plan_.shots.push_back(shot);
      }
    }
    set("shots", static_cast<double>(plan_.shots.size()));
  }

  const SurveyRequest& request_;
  const Pose start_W_;
  const GroundHeight& ground_;
  SurveyPlan plan_;
  RouteTask task_;
  SurveyRoute route_;
  SurveyClimb climb_;
  const GroundProfile* profile_ = nullptr;  // of climb_
  std::vector<double> wanted_m_, ramp_m_;   // at the profile's samples
  double climb_m_ = 0.0;
};

}  // namespace

Result<SurveyPlan> plan_survey(const SurveyRequest& request, const Pose& start_W,
                               const GroundHeight& ground) {
  return SurveyPlanner(request, start_W, ground).plan();
}

}  // namespace vinerow::controllers
