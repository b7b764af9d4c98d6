#pragma once
/// A vehicle that flies, in a world of its own; FixedWing and Quadrotor.

#include <string>
#include <utility>

#include "engine/api/registry.h"
#include "tests/vehicles/vehicle_rig.h"

namespace vinerow::vehicles::test {

template <class Params, class Vehicle>
struct FlightRig : VehicleRig<Vehicle> {
  /// @param rest_m  height of B above the ground at the start
  FlightRig(const std::string& name, const Params& the_params, double rest_m, WorldModel model,
            std::int64_t step_ns, double yaw_rad, double gravity)
      : VehicleRig<Vehicle>(std::move(model), settings(step_ns, gravity), Duration{step_ns},
                            yaw_rad, rest_m, the_params, context(name)),
        params(the_params) {}

  static physics::PhysicsSettings settings(std::int64_t step_ns, double gravity) {
    physics::PhysicsSettings result = settings_with_step(step_ns);
    result.gravity_mps2 = gravity;
    return result;
  }
  static VehicleContext context(const std::string& name) {
    VehicleContext context;
    context.vehicle = context.part = name;
    return context;
  }

  const physics::BodyState& body() const { return this->vehicle.body(); }
  Eigen::Vector3d rates_B() const { return body().X_WB.q.conjugate() * body().w_WB_W; }
  std::string crash() const { return std::string(this->vehicle.crash()); }

  Params params;
};

}  // namespace vinerow::vehicles::test
