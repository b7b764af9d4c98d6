#pragma once
/// A rover that drives circles of some ten metres on its own, for benchmarks of its step.

#include <memory>
#include <vector>

#include "engine/api/world_model.h"
#include "engine/physics/physics_world.h"
#include "tools/parts/register_all.h"

namespace vinerow::bench {

class DrivingRover {
 public:
  /// @param model  with terrain; outlives this object
  DrivingRover(const WorldModel& model, Duration step) : world_({}, model), step_(step) {
    register_all(registry_);
    VehicleContext context;
    context.vehicle = context.part = "rover";
    context.physics_step = step;
    rover_ = registry_.make_vehicle(
        "diff_drive_rover",
        ParameterSet(registry_.spec(PartKind::kVehicle, "diff_drive_rover").parameters), context);
    Pose X_WB;
    X_WB.p.z() = model.terrain->height_m(0, 0) + rover_->description().height_above_ground_m;
    rover_->spawn(world_, X_WB);
    const std::vector<double> circle{3.0, 5.0, 3.0, 5.0};
    rover_->actuate(circle);
  }

  void step() {
    rover_->before_physics(now_, step_);
    world_.step(step_);
    now_ = now_ + step_;
    rover_->after_physics(now_, step_);
  }
  physics::PhysicsWorld& world() { return world_; }

 private:
  Registry registry_;
  physics::PhysicsWorld world_;
  Duration step_;
  std::unique_ptr<Vehicle> rover_;
  Time now_;
};

}  // namespace vinerow::bench
