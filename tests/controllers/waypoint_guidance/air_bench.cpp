#include "tests/controllers/waypoint_guidance/air_bench.h"

#include <algorithm>
#include <cmath>

#include "engine/api/sees_ground.h"
#include "engine/api/world_model.h"
#include "engine/math/angles.h"

namespace vinerow::test {

VehicleDescription make_plane_description() {
  VehicleDescription description;
  description.type = "fixed_wing";
  description.mass_kg = 1.2;
  description.height_above_ground_m = 0.1;
  description.actuators = {{"throttle", "", 0.0, 1.0},
                           {"elevon_left_rad", "rad", -0.436, 0.436},
                           {"elevon_right_rad", "rad", -0.436, 0.436}};
  description.max_speed_mps = 20.0;
  FixedWingAircraft& aircraft = description.fixed_wing.emplace();
  aircraft.span_m = 0.9;
  aircraft.cruise_speed_mps = 12.0;
  aircraft.stall_speed_mps = 8.4;
  aircraft.max_bank_rad = rad_from_deg(45.0);
  aircraft.belly_height_m = 0.05;
  return description;
}

Plane::Plane(const PlaneOptions& options)
    : options_(options),
      p_W_(options.start_W),
      yaw_rad_(options.yaw_rad),
      speed_mps_(options.is_flying ? options.speed_mps : 0.0),
      has_left_(options.is_flying) {}

void Plane::advance(const AirReference& reference, double dt_s) {
  constexpr double kGravity = 9.80665, kLaunch_mps = 9.0, kBraking_mps2 = 4.0;
  if (!has_left_) {
    if (!reference.power) return;
    has_left_ = true;
    speed_mps_ = kLaunch_mps;
  }
  if (lies_) {
    speed_mps_ = std::max(0.0, speed_mps_ - kBraking_mps2 * dt_s);
    const Eigen::Vector2d along(std::cos(yaw_rad_), std::sin(yaw_rad_));
    const double before_m = ground_m();
    p_W_.head<2>() += dt_s * speed_mps_ * along;
    p_W_.z() += ground_m() - before_m;
    climb_mps_ = 0.0;
    return;
  }
  constexpr int kParts = 5;
  const double h = dt_s / kParts;
  for (int i = 0; i < kParts; ++i) {
    const double wanted_mps = reference.power ? reference.airspeed_mps : 0.0;
    speed_mps_ += h * std::clamp(wanted_mps - speed_mps_, -1.0, 3.0);
    const double error_rad = reference.heading_rad - yaw_rad_;
    const double bank_rad = std::clamp(-reference.bank_rad + 1.5 * error_rad, -0.8, 0.8);
    bank_left_rad_ += h * (bank_rad - bank_left_rad_) / options_.bank_lag_s;
    const double turn_radps = kGravity * std::tan(bank_left_rad_) / speed_mps_;
    yaw_rate_radps_ += h * (turn_radps - yaw_rate_radps_) / options_.yaw_lag_s;
    yaw_rad_ += h * yaw_rate_radps_;
    const double climb_mps =
        speed_mps_ * std::sin(reference.climb_angle_rad) + 0.5 * (reference.height_m - p_W_.z());
    climb_mps_ += h * (std::clamp(climb_mps, -4.0, 4.0) - climb_mps_) / 0.3;
    p_W_.x() += h * (speed_mps_ * std::cos(yaw_rad_) + options_.wind.x());
    p_W_.y() += h * (speed_mps_ * std::sin(yaw_rad_) + options_.wind.y());
    p_W_.z() += h * climb_mps_;
  }
  const Eigen::Vector2d over_ground(speed_mps_ * std::cos(yaw_rad_) + options_.wind.x(),
                                    speed_mps_ * std::sin(yaw_rad_) + options_.wind.y());
  const double lying_m = ground_m() + 0.05;
  const double rising_mps = calc_rise(over_ground) * over_ground.norm();
  if (p_W_.z() <= lying_m && climb_mps_ < rising_mps) {
    lies_ = true;
    touch_rise_ = calc_rise(over_ground);
    touch_mps_ = rising_mps - climb_mps_;
    p_W_.z() = lying_m;
    speed_mps_ = over_ground.norm();
  }
}

double Plane::ground_m() const {
  return options_.terrain ? options_.terrain(p_W_.head<2>()) : options_.ground_m;
}

double Plane::calc_rise(const Eigen::Vector2d& along) const {
  constexpr double kStep_m = 0.5;
  if (!options_.terrain || along.norm() == 0.0) return 0.0;
  const Eigen::Vector2d here = p_W_.head<2>(), step = kStep_m * along.normalized();
  return (options_.terrain(here + step) - options_.terrain(here - step)) / (2.0 * kStep_m);
}

Odometry Plane::odometry() const {
  Odometry odometry;
  odometry.X_WB = {quaternion_from_rpy({-bank_left_rad_, 0.0, yaw_rad_}), p_W_};
  const bool is_blown = has_left_ && !lies_;
  Eigen::Vector3d v_W(speed_mps_ * std::cos(yaw_rad_), speed_mps_ * std::sin(yaw_rad_), climb_mps_);
  if (is_blown) v_W.head<2>() += options_.wind;
  odometry.v_WB_B = odometry.X_WB.q.conjugate() * v_W;
  return odometry;
}

AirData Plane::air() const {
  const Odometry now = odometry();
  const Eigen::Vector3d wind_W(options_.wind.x(), options_.wind.y(), 0.0);
  return {now.v_WB_B - now.X_WB.q.conjugate() * wind_W};
}

AirBench::AirBench(const Values& values, const PlaneOptions& options, const std::string& type,
                   VehicleDescription vehicle)
    : Loop({.vehicle = "plane", .description = std::move(vehicle), .tick = Duration{50'000'000}}),
      plane(options) {
  Values all = values;
  if (options.has_air_data && type == "waypoint_guidance") all.emplace_back("air_data", "air");
  Guidance& guidance = add_guidance({type, all});
  if (auto* looks = dynamic_cast<SeesGround*>(&guidance); looks && options.terrain) {
    ground_.emplace([terrain = options.terrain](double x, double y) { return terrain({x, y}); });
    looks->see_ground(*ground_);
  }
  set_plant([this] { return plane.odometry(); },
            [this](double dt_s) { plane.advance(reference(), dt_s); });
  if (options.has_air_data) set_inputs([this] { write("air", plane.air()); });
}

void AirBench::fly(double longest_s, const Each& each) {
  while (time_s() < longest_s) {
    sense();
    decide();
    if (each) each(time_s(), read<Odometry>("estimate"), reference());
    move();
    if (reference().phase == AirPhase::kDone) return;
  }
}

PlannedPath make_waypoints(const std::vector<Eigen::Vector3d>& points) {
  PlannedPath plan;
  for (const Eigen::Vector3d& p_W : points) {
    PathPoint point;
    point.p_W = p_W;
    plan.points.push_back(point);
  }
  return plan;
}

PlannedPath make_lanes(int count, double length_m, double spacing_m, double height_m,
                       double yaw_rad) {
  std::vector<Eigen::Vector3d> points;
  const Eigen::AngleAxisd turn(yaw_rad, Eigen::Vector3d::UnitZ());
  for (int i = 0; i < count; ++i) {
    const double first = i % 2 == 0 ? 0.0 : length_m;
    for (const double y : {first, length_m - first}) {
      points.push_back(turn * Eigen::Vector3d(spacing_m * i, y, height_m));
    }
  }
  PlannedPath plan = make_waypoints(points);
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    plan.points[i].kind = i % 2 == 0 ? PathKind::kLeg : PathKind::kTurn;
    plan.points[i].alley = i % 2 == 0 ? static_cast<std::int32_t>(i / 2) : -1;
  }
  return plan;
}

}  // namespace vinerow::test
