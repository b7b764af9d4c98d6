#pragma once
/// Controller four_wheel_steering in a loop (loop.h) on a steered vehicle with exact kinematics.

#include "controllers/parts/paths/path_curve.h"
#include "tests/controllers/support/loop.h"

namespace vinerow::test {

/// Two straights of `length_m` side by side and the omega turn between them, to the left from the
/// origin, eastwards; headed by `heading_rad`.
PlannedPath make_omega(double radius_m, double spacing_m = 2.5, double length_m = 15.0,
                       double heading_rad = 0.0);
PlannedPath make_straight_plan(double length_m, double heading_rad = 0.0);

/// Errors of the true position from the planned curve.
struct Tracking {
  bool finished = false;
  double time_s = 0.0;
  double leg_rms_m = 0.0, turn_rms_m = 0.0, max_m = 0.0;
  double rms_m = 0.0;
};

struct LoopOptions {
  Values parameters = {};
  SteeredPlantOptions plant = {};
  Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();  ///< of the start
  double heading_error_rad = 0.0;                      ///< of the start
  bool encoders = false;                               ///< measure the true axle angles
  double settle_m = 0.0;                               ///< errors count from here on
  double longest_s = 200.0;
};

class SteeredLoop : public Loop {
 public:
  explicit SteeredLoop(const LoopOptions& options, const controllers::Pose2& start = {});
  void give_local(const LocalCommand& command) { write("local_command", command); }

  const SteeredPlant& plant() const { return plant_; }
  const VelocityCommand& command() const { return read<VelocityCommand>("command"); }
  double steering(const std::string& name) const { return value("steering", name); }

 private:
  SteeredPlant plant_;
};

Tracking track(const PlannedPath& plan, const LoopOptions& options = {});

}  // namespace vinerow::test
