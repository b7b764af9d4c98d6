#include "tests/controllers/support/mission.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/api/map.h"
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

MissionResult run_mission(const MissionSetup& setup) {
  const VehicleDescription& description = vehicle_for(setup.controller.type);
  std::unique_ptr<GroundPlant> plant = description.type == "test_rover"
                                           ? make_rover_plant(setup.start)
                                           : std::make_unique<SteeredPlant>(setup.start);
  MissionResult result;
  result.plan = plan_mission(setup);

  Loop loop(
      {.description = description, .tick = duration_from_s(setup.cycle_s), .map = &*setup.map});
  loop.set_plant(*plant);
  loop.set_stop_at(setup.stop_at_m);
  RandomStream random(setup.seed, "rover", "rover.gps");
  if (!setup.estimator.type.empty()) {
    loop.add_estimator(setup.estimator);
    loop.set_inputs([&] {
      const Odometry truth = plant->truth();
      GnssFix fix;
      fix.valid = true;
      fix.p_W = truth.X_WB.p;
      fix.v_W = truth.X_WB.q * truth.v_WB_B;
      fix.p_W.x() += random.uniform(-setup.accuracy_m, setup.accuracy_m);
      fix.p_W.y() += random.uniform(-setup.accuracy_m, setup.accuracy_m);
      fix.std_m.setConstant(setup.accuracy_m / std::sqrt(3.0));
      loop.write("gps", fix);
    });
  }
  loop.add_controller(setup.controller);
  loop.give_plan(result.plan);

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

  measure(setup.start);
  while (loop.time_s() < setup.longest_s) {
    loop.sense();
    loop.decide();
    result.finished = loop.finished();
    if (result.finished) break;
    loop.move();
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
