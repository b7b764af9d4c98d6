#pragma once
/// The registered controller on a steered vehicle with exact kinematics, without kernel.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "controllers/parts/paths/path_curve.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/parameters.h"
#include "engine/api/stepped_parts.h"
#include "tests/controllers/support/plant.h"

namespace vinerow::test {

using Values = std::vector<std::pair<std::string, ParameterSet::Value>>;

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
  bool encoders = false;                               ///< tells the true axle angles
  double settle_m = 0.0;                               ///< errors count from here on
  double longest_s = 200.0;
};

/// Controller, plant and signals; step() is one cycle of both.
class SteeredLoop {
 public:
  explicit SteeredLoop(const LoopOptions& options, const controllers::Pose2& start = {});
  void set_plan(const PlannedPath& plan) { plan_.write(now_, plan); }
  void set_local(const LocalCommand& command) { local_.write(now_, command); }
  void step();

  Time now() const { return now_; }
  Controller& controller() { return *controller_; }
  const SteeredPlant& plant() const { return plant_; }
  const std::vector<double>& actuators() const { return actuators_.value().values; }
  const FollowerState& follower() const { return follower_.value(); }
  const SignalReader<Event>& event() const { return event_; }
  const VelocityCommand& command() const { return command_.value(); }
  double steering(const std::string& name) const;

 private:
  VehicleDescription description_;
  SignalBus bus_;
  SteeredPlant plant_;
  bool has_encoders_;
  Time now_;
  SignalWriter<Odometry> estimate_;
  SignalWriter<PlannedPath> plan_;
  SignalWriter<LocalCommand> local_;
  SignalWriter<NamedValues> encoders_;
  std::unique_ptr<Controller> controller_;
  SignalReader<NamedValues> actuators_, steering_;
  SignalReader<FollowerState> follower_;
  SignalReader<VelocityCommand> command_;
  SignalReader<Event> event_;
};

std::unique_ptr<Controller> make_steered_controller(const Values& values,
                                                    const VehicleDescription& description);

Tracking track(const PlannedPath& plan, const LoopOptions& options = {});

}  // namespace vinerow::test
