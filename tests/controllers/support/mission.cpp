#include "tests/controllers/support/mission.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "controllers/register_controllers.h"
#include "engine/api/map.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::test {

RowMap make_paper_map() {
  RowMap map;
  for (int i = 0; i < 9; ++i) {
    PlantRow row;
    row.id = i;
    row.line_W = {{10.0 + 10.0 * i, 10.0, 0.0}, {10.0 + 10.0 * i, 90.0, 0.0}};
    row.canopy_width_m = 2.0;
    map.rows.push_back(row);
  }
  for (int i = 0; i < 10; ++i) {
    map.alleys.push_back({i, {{5.0 + 10.0 * i, 10.0, 0.0}, {5.0 + 10.0 * i, 90.0, 0.0}}, 10.0});
  }
  return map;
}

MissionSetup make_paper_mission(double pitch_m) {
  MissionSetup setup;
  setup.map = make_paper_map();
  setup.start = {{5.0, 10.0}, 0.5 * kPi};
  setup.planner.values = {{"waypoint_pitch_m", pitch_m}};
  return setup;
}

const Registry& parts() {
  static const Registry registry = [] {
    Registry r;
    controllers::register_controllers(r);
    return r;
  }();
  return registry;
}

std::vector<std::string> controllers_that_read(const std::string& signal) {
  std::vector<std::string> names;
  for (const std::string& name : parts().names(PartKind::kController)) {
    const std::vector<std::string>& reads = parts().spec(PartKind::kController, name).reads;
    if (std::find(reads.begin(), reads.end(), signal) != reads.end()) names.push_back(name);
  }
  return names;
}

std::vector<std::string> controllers_that_write(const std::string& signal) {
  std::vector<std::string> names;
  for (const std::string& name : parts().names(PartKind::kController)) {
    const std::vector<std::string>& writes = parts().spec(PartKind::kController, name).writes;
    if (std::find(writes.begin(), writes.end(), signal) != writes.end()) names.push_back(name);
  }
  return names;
}

ParameterSet make_parameters(const PartSpec& spec, const Values& values) {
  ParameterSet parameters(spec.parameters, spec.name);
  for (const auto& [name, value] : values) parameters.set(name, value);
  parameters.require_complete();
  return parameters;
}

const VehicleDescription& vehicle_for(const std::string& controller) {
  static const VehicleDescription rover = make_rover_description();
  static const VehicleDescription steered = make_steered_description();
  ControllerContext context;
  context.part = "rover.controller";
  context.period = Duration{25'000'000};
  context.vehicle_description = &rover;
  try {
    const PartSpec& spec = parts().spec(PartKind::kController, controller);
    parts().make_controller(controller, make_parameters(spec, {}), context);
    return rover;
  } catch (const ConfigError&) {
    return steered;
  }
}

std::unique_ptr<Planner> make_planner(const PartChoice& choice, const RowMap& map,
                                      const VehicleDescription* vehicle) {
  static const VehicleDescription description = make_rover_description();
  PlannerContext context;
  context.vehicle = "rover";
  context.part = "rover.planner";
  context.vehicle_description = vehicle != nullptr ? vehicle : &description;
  context.map = &map;
  const PartSpec& spec = parts().spec(PartKind::kPlanner, choice.type);
  return parts().make_planner(choice.type, make_parameters(spec, choice.values), context);
}

PlannedPath plan_mission(const MissionSetup& setup) {
  const Pose start = {quaternion_from_rpy({0, 0, setup.start.yaw_rad}),
                      {setup.start.p.x(), setup.start.p.y(), 0.0}};
  auto plan =
      make_planner(setup.planner, setup.map, &vehicle_for(setup.controller.type))->plan(start);
  if (!plan) std::fprintf(stderr, "no plan: %s\n", plan.reason().c_str());
  VINEROW_DEMAND(plan.ok());
  return std::move(plan).value();
}

namespace {

std::unique_ptr<Controller> make_controller(const MissionSetup& setup,
                                            const VehicleDescription& description) {
  ControllerContext context;
  context.vehicle = "rover";
  context.part = "rover.controller";
  context.period = duration_from_s(setup.cycle_s);
  context.vehicle_description = &description;
  context.map = &*setup.map;
  const PartSpec& spec = parts().spec(PartKind::kController, setup.controller.type);
  return parts().make_controller(setup.controller.type,
                                 make_parameters(spec, setup.controller.values), context);
}

std::unique_ptr<Estimator> make_estimator(const MissionSetup& setup,
                                          const VehicleDescription& description) {
  if (setup.estimator.type.empty()) return nullptr;
  EstimatorContext context;
  context.vehicle = "rover";
  context.part = "rover.estimator";
  context.period = duration_from_s(setup.cycle_s);
  context.vehicle_description = &description;
  context.map = &*setup.map;
  const PartSpec& spec = parts().spec(PartKind::kEstimator, setup.estimator.type);
  return parts().make_estimator(setup.estimator.type, make_parameters(spec, setup.estimator.values),
                                context);
}

}  // namespace

MissionResult run_mission(const MissionSetup& setup) {
  const VehicleDescription& description = vehicle_for(setup.controller.type);
  std::unique_ptr<Plant> plant = description.type == "test_rover"
                                     ? make_rover_plant(setup.start)
                                     : std::make_unique<SteeredPlant>(setup.start);
  MissionResult result;
  result.plan = plan_mission(setup);

  SignalBus bus;
  Ports world(bus, "rover", "test");
  auto truth_out = world.write<Odometry>("truth");
  auto plan_out = world.write<PlannedPath>("plan");
  auto gps_out = world.write<GnssFix>("gps");
  auto authority_out = world.write<MovementAuthority>("authority");
  const auto estimator = make_estimator(setup, description);
  SignalWriter<Odometry> estimate_out;
  if (estimator) {
    Ports ports(bus, "rover", "rover.estimator");
    estimator->connect(ports);
  } else {
    estimate_out = world.write<Odometry>("estimate");
  }
  const auto controller = make_controller(setup, description);
  Ports ports(bus, "rover", "rover.controller");
  controller->connect(ports);
  const auto actuators = world.read<NamedValues>("actuators");
  bus.check_connected();

  std::vector<Eigen::Vector2d> line;
  for (const PathPoint& point : result.plan.points) line.push_back(point.p_W.head<2>());
  DeviationMeter meter(line);
  double leg_square_m2 = 0.0;
  std::int64_t leg_samples = 0;
  const auto measure = [&](const controllers::Pose2& pose) {
    const auto nearest = meter.add(pose.p);
    if (result.plan.points[nearest.segment].kind == PathKind::kLeg) {
      leg_square_m2 += nearest.distance_m * nearest.distance_m;
      ++leg_samples;
    }
    result.poses.push_back(pose);
  };

  RandomStream random(setup.seed, "rover", "rover.gps");
  plan_out.write(Time{}, result.plan);
  measure(setup.start);
  const Duration period = duration_from_s(setup.cycle_s);
  for (Time now{}; now.s() < setup.longest_s; now = now + period) {
    const Odometry truth = plant->truth();
    truth_out.write(now, truth);
    GnssFix fix;
    fix.valid = true;
    fix.p_W = truth.X_WB.p;
    fix.v_W = truth.X_WB.q * truth.v_WB_B;
    fix.p_W.x() += random.uniform(-setup.accuracy_m, setup.accuracy_m);
    fix.p_W.y() += random.uniform(-setup.accuracy_m, setup.accuracy_m);
    fix.std_m.setConstant(setup.accuracy_m / std::sqrt(3.0));
    gps_out.write(now, fix);
    if (estimator) {
      estimator->step(now);
    } else {
      estimate_out.write(now, truth);
    }
    if (setup.stop_at_m) authority_out.write(now, {setup.stop_at_m(now.s()), -1, ""});
    controller->step(now);
    result.finished = controller->finished();
    if (result.finished) break;
    plant->drive(actuators.value().values, setup.cycle_s);
    result.max_yaw_rate_radps =
        std::max(result.max_yaw_rate_radps, std::abs(plant->truth().w_WB_B.z()));
    result.time_s += setup.cycle_s;
    measure(plant->pose());
  }
  result.average_m = meter.average_m();
  result.max_m = meter.max_m();
  result.oscillations = meter.oscillations();
  result.relative_accuracy = meter.relative_accuracy_per_m();
  result.leg_rms_m = leg_samples > 0 ? std::sqrt(leg_square_m2 / leg_samples) : 0.0;
  return result;
}

std::pair<double, double> run_seeds(MissionSetup setup, int count) {
  double sum = 0.0, sum2 = 0.0;
  for (int seed = 1; seed <= count; ++seed) {
    setup.seed = static_cast<std::uint64_t>(seed);
    const double ra = run_mission(setup).relative_accuracy;
    sum += ra;
    sum2 += ra * ra;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(sum2 / count - mean * mean, 0.0))};
}

}  // namespace vinerow::test
