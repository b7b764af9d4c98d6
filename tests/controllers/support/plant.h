#pragma once
/// Plants of the loop (loop.h), and rovers that move exactly as their actuators say.

#include <limits>
#include <memory>
#include <vector>

#include "controllers/parts/paths/pose2.h"
#include "engine/api/vehicle.h"

namespace vinerow::test {

/// A vehicle that moves by its actuators.
class Plant {
 public:
  virtual ~Plant() = default;
  /// Moves on with these actuator values, in the order of its description.
  virtual void step(const std::vector<double>& actuators, double dt_s) = 0;
  virtual Odometry truth() const = 0;
};

class GroundPlant : public Plant {
 public:
  /// Pose in plan.
  virtual controllers::Pose2 pose() const = 0;
};

/// Paper B's rover: 1 m track, 0.2 m wheels, four wheel speeds without limit.
VehicleDescription make_rover_description();
/// Moves by the mean speeds of its sides.
std::unique_ptr<GroundPlant> make_rover_plant(const controllers::Pose2& start);

/// Paper A's rover: two steered axles 1.5 m apart, 23 deg at most, four wheel speeds of 8 rad/s.
VehicleDescription make_steered_description();

/// What keeps a steered plant from rolling ideally.
struct SteeredPlantOptions {
  double steer_rate_radps = 2.0;
  double servo_lag_s = 0.0;  ///< first-order lag of the axles behind their command
  /// The ground is a plane that rises by this angle to the north.
  double slope_rad = 0.0;
  double slip_rad = 0.0;    ///< side slip per sine of the side slope: tyres giving way
  double turn_share = 1.0;  ///< yaw rate driven per yaw rate that the axles stand for
  double yaw_lag_s = 0.0;   ///< first-order lag of yaw rate and side slip: tyres and inertia
};

/// Rolls about the ICR of its axles: both axle midpoints move where their wheels point; forward
/// speed is the mean of the wheels'. Written without the code under test.
class SteeredPlant final : public GroundPlant {
 public:
  explicit SteeredPlant(const controllers::Pose2& start, const SteeredPlantOptions& options = {});
  void step(const std::vector<double>& actuators, double dt_s) override;
  controllers::Pose2 pose() const override;
  Odometry truth() const override;

  double front_rad() const { return front_rad_; }
  double rear_rad() const { return rear_rad_; }

 private:
  void move(const std::vector<double>& actuators, double dt_s);

  SteeredPlantOptions options_;
  controllers::Pose2 in_plane_;  ///< on the sloping plane, x east along the contour
  double front_rad_ = 0.0, rear_rad_ = 0.0;
  Eigen::Vector2d v_B_ = Eigen::Vector2d::Zero();
  double yaw_rate_radps_ = 0.0;
  double slip_tan_ = 0.0, curvature_per_m_ = 0.0;
};

}  // namespace vinerow::test
