#include "controllers/dwa/obstacle_memory.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

// An arc's points are slightly off the true surface; free beams do not count this near an echo.
constexpr double kFreeBefore_m = 0.12;
// The cone's rim is not detected with certainty.
constexpr double kRim_rad = 0.0175;
// Points nearer than this to the vehicle's centre do not expire.
constexpr double kNear_m = 3.0;
constexpr double kMerge_m = 0.8 * ObstacleMemory::kPitch_m;

}  // namespace

ObstacleMemory::ObstacleMemory(const ObstacleMemoryParams& params,
                               std::vector<SensorMounting> sensors, const DistanceField& known,
                               std::vector<Eigen::Vector2d> outline_B, double height_m)
    : params_(params),
      sensors_(std::move(sensors)),
      known_(&known),
      outline_B_(std::move(outline_B)),
      height_m_(height_m),
      samples_(sensors_.size()),
      beams_(sensors_.size()),
      points_(kCapacity),
      confirmed_W_(kCapacity, Eigen::Vector2d::Zero()) {}

void ObstacleMemory::clear() {
  count_ = confirmed_count_ = 0;
  for (Beam& beam : beams_) beam = {};
}

void ObstacleMemory::read(int sensor, const RangeSample& sample) {
  samples_[sensor] = sample;
  beams_[sensor].is_new = beams_[sensor].has_value = true;
}

void ObstacleMemory::place(Beam* beam, const SensorMounting& sensor, const Pose& X_WB) const {
  const Eigen::Vector3d axis_B = sensor.X_BS.q * Eigen::Vector3d::UnitX();
  const Pose X_WS = X_WB * sensor.X_BS;
  const Eigen::Vector3d axis_W = X_WS.q * Eigen::Vector3d::UnitX();
  const RangeSample& sample = samples_[&sensor - sensors_.data()];
  beam->p_W = X_WS.p.head<2>();
  const double level = axis_W.head<2>().norm();
  beam->axis_W = level > 1e-6 ? Eigen::Vector2d(axis_W.head<2>() / level) : Eigen::Vector2d(1, 0);
  beam->half_angle_rad = sample.half_angle_rad;
  beam->cos_free = std::cos(std::max(sample.half_angle_rad - kRim_rad, 0.0));
  beam->range_m = sample.range_m * level;
  // The vehicle is on the ground, so its own plane is the ground's except for ground_slope.
  const double down_rad = std::asin(std::clamp(-axis_B.z(), -1.0, 1.0)) + sample.half_angle_rad +
                          params_.ground_slope_rad;
  const double height_m = height_m_ + sensor.X_BS.p.z();
  beam->ground_m = down_rad > 0.0
                       ? std::max(height_m, 0.0) / std::sin(std::min(down_rad, 0.5 * kPi))
                       : std::numeric_limits<double>::infinity();
}

bool ObstacleMemory::is_seen_through(const Eigen::Vector2d& p_W, const Beam& beam) const {
  const Eigen::Vector2d offset = p_W - beam.p_W;
  const double distance_m = offset.norm();
  // Free space ends where echoes are no longer used.
  const double free_m = std::min(beam.range_m, params_.obstacle_range_m + 0.5) - kFreeBefore_m;
  return beam.has_value && distance_m < free_m &&
         offset.dot(beam.axis_W) > distance_m * beam.cos_free;
}

bool ObstacleMemory::is_on_vehicle(const Eigen::Vector2d& p_W, const Pose2& pose) const {
  const Eigen::Vector2d ahead = direction(pose.yaw_rad), offset = p_W - pose.p;
  const Eigen::Vector2d p_B(offset.dot(ahead), offset.dot(left_of(ahead)));
  for (std::size_t i = 0; i < outline_B_.size(); ++i) {
    const Eigen::Vector2d &a = outline_B_[i], &b = outline_B_[(i + 1) % outline_B_.size()];
    if (cross(b - a, p_B - a) <= 0.0) return false;
  }
  return true;
}

void ObstacleMemory::clear_free_points(Time now, const Pose2& pose) {
  int kept = 0;
  for (int i = 0; i < count_; ++i) {
    Point point = points_[i];
    const bool is_old = (now - point.seen).s() > params_.forget_s;
    if (is_old && (point.p_W - pose.p).norm() > kNear_m) continue;
    if (is_on_vehicle(point.p_W, pose)) continue;
    bool is_free = false;
    for (const Beam& beam : beams_) {
      is_free = is_free || (beam.is_new && is_seen_through(point.p_W, beam));
    }
    if (is_free && ++point.misses >= kMissesToClear) continue;
    points_[kept++] = point;
  }
  count_ = kept;
}

bool ObstacleMemory::is_explained(const Beam& beam) const {
  if (!(beam.range_m <= params_.obstacle_range_m) || beam.range_m >= beam.ground_m) return true;
  const int parts =
      2 * static_cast<int>(std::ceil(beam.range_m * beam.half_angle_rad / kPitch_m)) + 2;
  for (int i = 0; i <= parts; ++i) {
    const double angle = beam.half_angle_rad * (2.0 * i / parts - 1.0);
    const Eigen::Vector2d to =
        std::cos(angle) * beam.axis_W + std::sin(angle) * left_of(beam.axis_W);
    if (known_->at(beam.p_W + beam.range_m * to) <= params_.map_tolerance_m) return true;
  }
  return false;
}

void ObstacleMemory::mark(const Eigen::Vector2d& p_W, Time now) {
  int nearest = -1;
  double nearest_m = kMerge_m;
  for (int i = 0; i < count_; ++i) {
    const double gap_m = (points_[i].p_W - p_W).norm();
    if (gap_m < nearest_m) nearest = i, nearest_m = gap_m;
  }
  if (nearest >= 0) {
    Point& point = points_[nearest];
    if (point.update != updates_) ++point.hits;
    point.update = updates_;
    point.seen = now;
    point.misses = 0;
    return;
  }
  if (count_ == kCapacity) {
    // The point with the oldest echo is replaced.
    const auto oldest =
        std::min_element(points_.begin(), points_.end(),
                         [](const Point& a, const Point& b) { return a.seen < b.seen; });
    *oldest = {p_W, now, 1, 0, updates_};
    return;
  }
  points_[count_++] = {p_W, now, 1, 0, updates_};
}

void ObstacleMemory::mark_arc(int sensor, Time now, const Pose2& pose) {
  const Beam& beam = beams_[sensor];
  const double half_m = beam.range_m * beam.half_angle_rad;
  const int parts = 2 * std::max(1, static_cast<int>(std::ceil(half_m / kPitch_m)));
  for (int i = 0; i <= parts; ++i) {
    const double angle = beam.half_angle_rad * (2.0 * i / parts - 1.0);
    const Eigen::Vector2d to =
        std::cos(angle) * beam.axis_W + std::sin(angle) * left_of(beam.axis_W);
    const Eigen::Vector2d p_W = beam.p_W + beam.range_m * to;
    bool is_free = is_on_vehicle(p_W, pose);
    for (const Beam& other : beams_) {
      is_free = is_free || (&other != &beam && is_seen_through(p_W, other));
    }
    if (!is_free) mark(p_W, now);
  }
}

void ObstacleMemory::update(Time now, const Pose& X_WB) {
  ++updates_;
  const Pose2 pose{X_WB.p.head<2>(), yaw_from_quaternion(X_WB.q)};
  for (int i = 0; i < sensor_count(); ++i) {
    if (beams_[i].is_new) place(&beams_[i], sensors_[i], X_WB);
  }
  clear_free_points(now, pose);
  for (int i = 0; i < sensor_count(); ++i) {
    Beam& beam = beams_[i];
    if (!beam.is_new) continue;
    const bool is_steady =
        beam.streak > 0 && std::abs(beam.range_m - beam.last_m) < params_.consistency_m;
    beam.last_m = beam.range_m;
    beam.streak = is_explained(beam) ? 0 : is_steady ? beam.streak + 1 : 1;
    if (beam.streak >= params_.consistent_echoes) mark_arc(i, now, pose);
  }
  for (Beam& beam : beams_) beam.is_new = false;
  confirmed_count_ = 0;
  for (int i = 0; i < count_; ++i) {
    if (points_[i].hits >= params_.hits) confirmed_W_[confirmed_count_++] = points_[i].p_W;
  }
}

double ObstacleMemory::nearest_ahead_m(const Pose2& pose, double x_m, double half_width_m) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d ahead = direction(pose.yaw_rad);
  for (const Eigen::Vector2d& p_W : obstacles_W()) {
    const Eigen::Vector2d offset = p_W - pose.p;
    const double x = offset.dot(ahead) - x_m;
    if (x > 0.0 && std::abs(offset.dot(left_of(ahead))) <= half_width_m) {
      nearest_m = std::min(nearest_m, x);
    }
  }
  return nearest_m;
}

}  // namespace vinerow::controllers
