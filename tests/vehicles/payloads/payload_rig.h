#pragma once
/// A payload on a body that the test moves, in a world of box-shaped rows on flat ground.

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "engine/api/map.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/physics/world_scene.h"
#include "tests/engine/sensors/sensor_bench.h"
#include "tests/vehicles/small_worlds.h"
#include "vehicles/register_vehicles.h"

namespace vinerow::vehicles::test {

using PayloadValues = std::vector<std::pair<std::string, ParameterSet::Value>>;

/// A box of canopy along x.
struct BoxRow {
  double y_m = 0.0;
  double half_width_m = 0.25;
  double base_m = 0.5;
  double top_m = 2.0;
  double from_x_m = 0.0;
  double to_x_m = 20.0;
};

/// Flat ground, a row and its canopy for each box; ids are 10, 11, 12 ...
inline WorldModel make_box_rows(const std::vector<BoxRow>& boxes) {
  WorldModel world = make_flat_world();
  for (const BoxRow& box : boxes) {
    const int id = 10 + static_cast<int>(world.rows->rows.size());
    world.rows->rows.push_back({id,
                                {{box.from_x_m, box.y_m, 0.0}, {box.to_x_m, box.y_m, 0.0}},
                                2.0 * box.half_width_m,
                                box.base_m,
                                box.top_m});
    world.meshes.push_back(
        make_box("row",
                 Eigen::Vector3d(0.5 * (box.to_x_m - box.from_x_m), box.half_width_m,
                                 0.5 * (box.top_m - box.base_m))
                     .cast<float>(),
                 {0.5 * (box.from_x_m + box.to_x_m), box.y_m, 0.5 * (box.base_m + box.top_m)},
                 SurfaceClass::kCanopy));
  }
  return world;
}

inline double area_of(const MeshInstance& instance) {
  double area_m2 = 0.0;
  for (const auto& [a, b, c] : instance.mesh->triangles) {
    const auto corner = [&](std::uint32_t i) {
      return Eigen::Vector3d(instance.X_WM * instance.mesh->vertices[i].cast<double>());
    };
    area_m2 += 0.5 * (corner(b) - corner(a)).cross(corner(c) - corner(a)).norm();
  }
  return area_m2;
}

inline const Registry& vehicle_registry() {
  static const Registry registry = [] {
    Registry r;
    vehicles::register_vehicles(r);
    return r;
  }();
  return registry;
}

struct PayloadRig {
  PayloadRig(const std::string& type, WorldModel model, const PayloadValues& values = {},
             std::uint64_t seed = 1, const RowMap* map = nullptr, double rate_Hz = 0.0)
      : world(std::move(model)), scene(world) {
    const PartSpec& spec = vehicle_registry().spec(PartKind::kPayload, type);
    ParameterSet parameters(spec.parameters, type);
    for (const auto& [name, value] : values) parameters.set(name, value);
    PayloadContext context;
    context.vehicle = "rover";
    context.part = "rover.p";
    context.name = "p";
    context.seed = seed;
    period = period_of_rate(rate_Hz > 0.0 ? rate_Hz : spec.default_rate_Hz);
    context.period = period;
    context.scene = &scene;
    context.world = &world;
    context.vehicle_truth = &vehicle;
    vehicle.description_.height_above_ground_m = 0.4;
    context.vehicle_description = &vehicle.description();
    context.map = map != nullptr ? map : &*world.rows;
    payload = vehicle_registry().make_payload(type, parameters, context);
    Ports ports(bus, "rover", "rover.p");
    payload->connect(ports);
    bus.check_connected();
    signal = bus.subscribe<NamedValues>("rover/p", "test");
    event = bus.subscribe_optional<Event>("rover/p_event", "test");
  }

  /// One tick with B's origin 0.4 m above the ground at (x, y). @param estimate_error_x_m  estimate
  /// - truth
  void tick(double x_m, double y_m, double yaw_rad, double speed_mps,
            double estimate_error_x_m = 0.0) {
    Odometry odometry;
    odometry.X_WB.p = {x_m, y_m, z_m};
    odometry.X_WB.q = quaternion_from_rpy({0.0, 0.0, yaw_rad});
    odometry.v_WB_B = {speed_mps, 0.0, 0.0};
    truth.write(now, odometry);
    odometry.X_WB.p.x() += estimate_error_x_m;
    estimate.write(now, odometry);
    payload->step(now);
    now = now + period;
  }
  /// A straight pass along x at a constant speed.
  void pass(double from_x_m, double to_x_m, double y_m, double speed_mps,
            double estimate_error_x_m = 0.0) {
    const double sign = to_x_m > from_x_m ? 1.0 : -1.0;
    for (double distance_m = 0.0; distance_m <= std::abs(to_x_m - from_x_m);
         distance_m += speed_mps * period.s()) {
      tick(from_x_m + sign * distance_m, y_m, sign > 0.0 ? 0.0 : kPi, speed_mps,
           estimate_error_x_m);
    }
  }
  double signal_value(const std::string& name) const {
    const NamedValues& values = signal.value();
    for (std::size_t i = 0; i < values.names.size(); ++i) {
      if (values.names[i] == name) return values.values[i];
    }
    ADD_FAILURE() << "no value '" << name << "'";
    return 0.0;
  }
  double result(const std::string& name) const { return payload->results().at(name); }
  const std::vector<CanopyPatch>& patches() const { return payload->coverage()->patches; }

  WorldModel world;
  physics::WorldScene scene;
  vinerow::test::FixedVehicle vehicle;
  SignalBus bus;
  SignalWriter<Odometry> truth = bus.advertise<Odometry>("rover/truth", "rover");
  SignalWriter<Odometry> estimate = bus.advertise<Odometry>("rover/estimate", "rover.estimator");
  SignalWriter<PlannedPath> plan = bus.advertise<PlannedPath>("rover/plan", "rover.planner");
  SignalReader<NamedValues> signal;
  SignalReader<Event> event;
  std::unique_ptr<Payload> payload;
  Duration period;
  Time now;
  double z_m = 0.4;  ///< of B's origin
};

template <class F>
std::string config_error_of(F&& f) {
  try {
    f();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "no error";
}

}  // namespace vinerow::vehicles::test
