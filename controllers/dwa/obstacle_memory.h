#pragma once
/// Memory of obstacles that ultrasonic rangers detect and the map lacks, as points.
///
/// A reading means that something is on an arc across the cone and nothing is in the cone before
/// it. So an echo adds points along the arc, except where another sensor's cone is free; cones that
/// overlap narrow the arcs down to the true place. An echo is ignored if
/// - it is farther than obstacle_range_m,
/// - any part of its arc is within map_tolerance_m of something on the map (canopies, posts),
/// - it may come from the ground: the cone's lower edge, tilted by ground_slope, meets the ground
///   under the vehicle before it,
/// - the sensor's previous readings do not agree with it (consistent_echoes in a row).
/// A point counts after `hits` readings. It is forgotten when the cones see through it
/// kMissesToClear times in a row, when the vehicle is on it, or forget_s after its last hit if the
/// vehicle is 3 m away by then. The cones do not cover the sides and the space close before the
/// vehicle: a vehicle that has stopped before an obstacle must not forget it there.
///
/// Everything happens in the horizontal plane, at the estimated pose at the time of the update. The
/// motion of the vehicle between measurement and update (a sensor's delay) is not compensated.

#include <span>
#include <vector>

#include "controllers/parts/paths/distance_field.h"
#include "controllers/parts/paths/pose2.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/stepped_parts.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

struct ObstacleMemoryParams {
  double obstacle_range_m = 2.5;
  double map_tolerance_m = 0.25;
  double ground_slope_rad = rad_from_deg(5.0);  ///< ground ahead rises by at most this
  int consistent_echoes = 2;
  double consistency_m = 0.25;  ///< readings in a row differ by less
  int hits = 2;
  double forget_s = 30.0;
};

class ObstacleMemory {
 public:
  static constexpr int kCapacity = 256;
  static constexpr int kMissesToClear = 3;
  static constexpr double kPitch_m = 0.1;  ///< between points of an arc

  /// @param sensors  mountings of rangers, in the order of the readings
  /// @param known    the map's distances; must outlive this
  /// @param outline_B  convex, counter-clockwise: the vehicle
  /// @param height_m  of B's origin above the ground
  ObstacleMemory(const ObstacleMemoryParams& params, std::vector<SensorMounting> sensors,
                 const DistanceField& known, std::vector<Eigen::Vector2d> outline_B,
                 double height_m);

  int sensor_count() const { return static_cast<int>(sensors_.size()); }

  /// A sensor's reading; call before update(), and only if it is new.
  void read(int sensor, const RangeSample& sample);
  /// Processes the readings since the last call. No heap.
  void update(Time now, const Pose& X_WB);
  void clear();

  /// Confirmed points. Valid until the next update.
  std::span<const Eigen::Vector2d> obstacles_W() const {
    return {confirmed_W_.data(), static_cast<std::size_t>(confirmed_count_)};
  }
  /// Distance to the nearest point ahead within half_width_m of the vehicle's axis, m from x_m (of
  /// B); infinity without such a point.
  double nearest_ahead_m(const Pose2& pose, double x_m, double half_width_m) const;

 private:
  struct Beam {
    Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
    Eigen::Vector2d axis_W = Eigen::Vector2d::UnitX();
    double range_m = 0.0;  ///< in the horizontal plane
    double half_angle_rad = 0.0;
    double cos_free = 1.0;  ///< of the angle within which the cone detects with certainty
    double ground_m = 0.0;  ///< echoes from here on may be the ground
    double last_m = 0.0;
    int streak = 0;
    bool is_new = false;
    bool has_value = false;
  };
  struct Point {
    Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
    Time seen;
    int hits = 0;
    int misses = 0;
    std::uint64_t update = 0;  ///< of the last hit
  };

  void place(Beam* beam, const SensorMounting& sensor, const Pose& X_WB) const;
  bool is_seen_through(const Eigen::Vector2d& p_W, const Beam& beam) const;
  bool is_on_vehicle(const Eigen::Vector2d& p_W, const Pose2& pose) const;
  void clear_free_points(Time now, const Pose2& pose);
  bool is_explained(const Beam& beam) const;
  void mark_arc(int sensor, Time now, const Pose2& pose);
  void mark(const Eigen::Vector2d& p_W, Time now);

  ObstacleMemoryParams params_;
  std::vector<SensorMounting> sensors_;
  const DistanceField* known_;
  std::vector<Eigen::Vector2d> outline_B_;
  double height_m_;
  std::vector<RangeSample> samples_;
  std::vector<Beam> beams_;
  std::vector<Point> points_;  // kCapacity places, the first count_ in use
  int count_ = 0;
  std::uint64_t updates_ = 0;
  std::vector<Eigen::Vector2d> confirmed_W_;
  int confirmed_count_ = 0;
};

}  // namespace vinerow::controllers
