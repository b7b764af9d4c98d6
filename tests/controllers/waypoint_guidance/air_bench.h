#pragma once
/// Guidances that write AirReference in a loop (loop.h) with a point that flies turns in a uniform
/// wind: bank and climb follow with lags, and the heading's rate is g tan(bank) / V, with another
/// lag.

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/messages/flight.h"
#include "engine/api/messages/sensors.h"
#include "tests/controllers/support/loop.h"
#include "tests/support/plain_scene.h"

namespace vinerow::test {

using AirPhase = AirReference::Phase;

/// The numbers of the aircraft of the reference of paper A, section 1.
VehicleDescription make_plane_description();

struct PlaneOptions {
  Eigen::Vector3d start_W = {0.0, 0.0, 0.1};
  double yaw_rad = 0.0;
  bool is_flying = true;  ///< else it lies on a launcher until the reference wants power
  Eigen::Vector2d wind = Eigen::Vector2d::Zero();
  bool has_air_data = true;  ///< writes AirData "air"
  double bank_lag_s = 0.15;
  double yaw_lag_s = 0.2;
  double speed_mps = 12.0;
  double ground_m = 0.0;  ///< z where the fuselage lies, on flat ground
  /// Height of ground that is not flat, as the guidance receives it.
  std::function<double(const Eigen::Vector2d&)> terrain;
};

class Plane {
 public:
  explicit Plane(const PlaneOptions& options);
  void advance(const AirReference& reference, double dt_s);
  Odometry odometry() const;
  AirData air() const;
  double bank_left_rad() const { return bank_left_rad_; }
  /// How fast the ground came nearer when it touched, m/s; NaN in the air.
  double touch_mps() const { return touch_mps_; }
  /// Of the ground along its way there.
  double touch_rise() const { return touch_rise_; }

 private:
  double ground_m() const;
  double calc_rise(const Eigen::Vector2d& along) const;
  PlaneOptions options_;
  Eigen::Vector3d p_W_;
  double yaw_rad_, bank_left_rad_ = 0.0, yaw_rate_radps_ = 0.0, speed_mps_, climb_mps_ = 0.0;
  bool has_left_, lies_ = false;
  double touch_mps_ = std::numeric_limits<double>::quiet_NaN(), touch_rise_ = 0.0;
};

/// The guidance and the plane in a loop of 50 ms. The plan is given by give_plan().
class AirBench : public Loop {
 public:
  explicit AirBench(const Values& values = {}, const PlaneOptions& plane = {},
                    const std::string& type = "waypoint_guidance",
                    VehicleDescription vehicle = make_plane_description());

  const AirReference& reference() const { return read<AirReference>("reference"); }
  /// The loop's, with what the guidance wants then.
  const AirReference& tick() { return Loop::tick(), reference(); }
  const AirReference& step() { return Loop::step(), reference(); }
  const AirReference& step(const Odometry& estimate) { return Loop::step(estimate), reference(); }
  /// Ticks until kDone or longest_s; `each` sees what the guidance saw and wanted.
  using Each = std::function<void(double time_s, const Odometry&, const AirReference&)>;
  void fly(double longest_s, const Each& each = {});

  Plane plane;

 private:
  std::optional<PlainScene> ground_;
};

/// A plan of waypoints with straight legs.
PlannedPath make_waypoints(const std::vector<Eigen::Vector3d>& points);
/// Lanes of this length, northwards first, from the origin to the east, turned by yaw.
PlannedPath make_lanes(int count, double length_m, double spacing_m, double height_m,
                       double yaw_rad = 0.0);

}  // namespace vinerow::test
