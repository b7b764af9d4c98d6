#include "tests/controllers/support/plant.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "controllers/parts/ground_drive/differential_drive.h"
#include "engine/math/angles.h"

namespace vinerow::test {
namespace {

constexpr double kRoverTrack_m = 1.0, kRoverRadius_m = 0.2;
constexpr double kAxle_m = 0.75, kTrack_m = 0.85, kRadius_m = 0.2;

/// Speeds that the mean wheel speed of each side stands for, wheels as in make_rover_description():
/// fl, fr, rl, rr, rad/s.
VelocityCommand unmix(const std::vector<double>& wheels_radps) {
  const double left_mps = 0.5 * kRoverRadius_m * (wheels_radps[0] + wheels_radps[2]);
  const double right_mps = 0.5 * kRoverRadius_m * (wheels_radps[1] + wheels_radps[3]);
  return {0.5 * (left_mps + right_mps), (right_mps - left_mps) / kRoverTrack_m};
}

class RoverPlant final : public GroundPlant {
 public:
  explicit RoverPlant(const controllers::Pose2& start) : pose_(start) {}
  void step(const std::vector<double>& actuators, double dt_s) override {
    driven_ = unmix(actuators);
    pose_ = controllers::advance(pose_, driven_.v_mps * dt_s, driven_.yaw_rate_radps * dt_s);
  }
  controllers::Pose2 pose() const override { return pose_; }
  Odometry truth() const override {
    Odometry truth;
    truth.X_WB = {quaternion_from_rpy({0, 0, pose_.yaw_rad}), {pose_.p.x(), pose_.p.y(), 0.0}};
    truth.v_WB_B.x() = driven_.v_mps;
    truth.w_WB_B.z() = driven_.yaw_rate_radps;
    return truth;
  }

 private:
  controllers::Pose2 pose_;
  VelocityCommand driven_;
};

/// A pose in plan stands on a plane that rises to the north: its heading there is steeper.
controllers::Pose2 put_on_plane(const controllers::Pose2& plan, double slope_rad) {
  const double stretch = 1.0 / std::cos(slope_rad);
  const Eigen::Vector2d t = controllers::direction(plan.yaw_rad);
  return {{plan.p.x(), plan.p.y() * stretch}, std::atan2(t.y() * stretch, t.x())};
}

double follow(double from, double to, double dt_s, double lag_s) {
  return lag_s > 0.0 ? from + (1.0 - std::exp(-dt_s / lag_s)) * (to - from) : to;
}

}  // namespace

VehicleDescription make_rover_description() {
  VehicleDescription description;
  description.type = "test_rover";
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  for (const char* place : {"fl", "fr", "rl", "rr"}) {
    description.actuators.push_back(
        {std::string("wheel_") + place + "_speed_radps", "rad/s", -kNoLimit, kNoLimit});
  }
  description.wheeled = {.track_m = kRoverTrack_m, .wheel_radius_m = kRoverRadius_m};
  return description;
}

std::unique_ptr<GroundPlant> make_rover_plant(const controllers::Pose2& start) {
  return std::make_unique<RoverPlant>(start);
}

VehicleDescription make_steered_description() {
  VehicleDescription description;
  description.type = "test_steered_rover";
  const double limit = rad_from_deg(23.0);
  description.actuators = {{"axle_front_steer_rad", "rad", -limit, limit},
                           {"axle_rear_steer_rad", "rad", -limit, limit}};
  for (const char* place : {"fl", "fr", "rl", "rr"}) {
    description.actuators.push_back(
        {std::string("wheel_") + place + "_speed_radps", "rad/s", -8.0, 8.0});
  }
  description.max_speed_mps = 1.6;
  description.min_turning_radius_m = 1.767;
  description.wheeled = {.track_m = kTrack_m,
                         .wheel_base_m = 2.0 * kAxle_m,
                         .wheel_radius_m = kRadius_m,
                         .wheel_speed_limit_radps = 8.0};
  description.steered = {.front_axle_m = kAxle_m,
                         .rear_axle_m = kAxle_m,
                         .max_axle_steer_rad = limit,
                         .steer_rate_radps = 2.0};
  return description;
}

SteeredPlant::SteeredPlant(const controllers::Pose2& start, const SteeredPlantOptions& options)
    : options_(options), in_plane_(put_on_plane(start, options.slope_rad)) {}

void SteeredPlant::move(const std::vector<double>& actuators, double dt_s) {
  const double step = options_.steer_rate_radps * dt_s;
  const auto turn = [&](double from, double to) {
    const double wanted = follow(from, to, dt_s, options_.servo_lag_s);
    return from + std::clamp(wanted - from, -step, step);
  };
  front_rad_ = turn(front_rad_, actuators[0]);
  rear_rad_ = turn(rear_rad_, actuators[1]);

  // Both midpoints along their wheels: v_y + a w = v_x tan dF, v_y - b w = v_x tan dR.
  const double front = std::tan(front_rad_), rear = std::tan(rear_rad_);
  const double k = (front - rear) / (2.0 * kAxle_m), s = front - kAxle_m * k;
  double forward = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double x = i < 2 ? kAxle_m : -kAxle_m, y = (i % 2 == 0 ? 0.5 : -0.5) * kTrack_m;
    const double wheel_rad = std::atan((s + k * x) / (1.0 - k * y));
    forward += 0.25 * actuators[2 + i] * kRadius_m * std::cos(wheel_rad);
  }
  // The part of gravity across the vehicle: downhill is to the south.
  const double down = -std::sin(options_.slope_rad) * std::cos(in_plane_.yaw_rad);
  slip_tan_ = follow(slip_tan_, s + options_.slip_rad * down, dt_s, options_.yaw_lag_s);
  curvature_per_m_ = follow(curvature_per_m_, options_.turn_share * k, dt_s, options_.yaw_lag_s);
  v_B_ = {forward, forward * slip_tan_};
  yaw_rate_radps_ = forward * curvature_per_m_;
  // A constant twist moves along an arc in the direction of travel.
  const double side = std::atan2(v_B_.y(), v_B_.x());
  const controllers::Pose2 moved = controllers::advance({in_plane_.p, in_plane_.yaw_rad + side},
                                                        v_B_.norm() * dt_s, yaw_rate_radps_ * dt_s);
  in_plane_ = {moved.p, moved.yaw_rad - side};
}

void SteeredPlant::step(const std::vector<double>& actuators, double dt_s) {
  constexpr int kParts = 10;
  for (int i = 0; i < kParts; ++i) move(actuators, dt_s / kParts);
}

controllers::Pose2 SteeredPlant::pose() const {
  const double shrink = std::cos(options_.slope_rad);
  const Eigen::Vector2d t = controllers::direction(in_plane_.yaw_rad);
  return {{in_plane_.p.x(), in_plane_.p.y() * shrink}, std::atan2(t.y() * shrink, t.x())};
}

Odometry SteeredPlant::truth() const {
  const double rise = std::sin(options_.slope_rad), plan = std::cos(options_.slope_rad);
  Odometry truth;
  truth.X_WB.p = {in_plane_.p.x(), plan * in_plane_.p.y(), rise * in_plane_.p.y()};
  truth.X_WB.q = Eigen::AngleAxisd(options_.slope_rad, Eigen::Vector3d::UnitX()) *
                 Eigen::AngleAxisd(in_plane_.yaw_rad, Eigen::Vector3d::UnitZ());
  truth.v_WB_B.head<2>() = v_B_;
  truth.w_WB_B.z() = yaw_rate_radps_;
  return truth;
}

}  // namespace vinerow::test
