#include "tests/controllers/trajectory/flight_world.h"

#include <cmath>

#include "engine/api/world_model.h"
#include "engine/math/angles.h"

namespace vinerow::test {

PlainScene make_flat(double height_m) {
  return PlainScene([height_m](double, double) { return height_m; });
}

PlainScene make_bumpy_slope() {
  return PlainScene([](double x, double y) {
    return 20.0 + 0.16 * y + 0.15 * std::sin(2.0 * kPi * (y + 0.5 * x) / 12.0);
  });
}

RowMap put_on(RowMap map, const PlainScene& hill) {
  // Points of the centre lines a metre apart, so that they follow the ground.
  const auto follow = [&hill](const std::vector<Eigen::Vector3d>& line) {
    std::vector<Eigen::Vector3d> fine;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const int parts = static_cast<int>(std::ceil((line[i + 1] - line[i]).norm()));
      for (int k = 0; k < parts; ++k) {
        fine.push_back(line[i] + (line[i + 1] - line[i]) * k / parts);
      }
    }
    fine.push_back(line.back());
    for (Eigen::Vector3d& p : fine) p.z() = hill.ground_m(p.head<2>());
    return fine;
  };
  for (PlantRow& row : map.rows) row.line_W = follow(row.line_W);
  for (Alley& alley : map.alleys) alley.line_W = follow(alley.line_W);
  return map;
}

VehicleDescription make_quadrotor_description() {
  VehicleDescription description;
  description.type = "quadrotor";
  description.mass_kg = 2.0;
  description.height_above_ground_m = 0.2;
  description.collision_half_extents_m = {0.36, 0.36, 0.15};
  for (int i = 0; i < 8; ++i) {
    const double angle = 0.25 * kPi * i;
    description.footprint_B.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle));
  }
  description.max_speed_mps = 10.0;
  description.min_turning_radius_m = 1.77;
  Rotorcraft& craft = description.rotorcraft.emplace();
  const double arm_m = 0.31 * std::sqrt(0.5);
  for (int i = 0; i < 4; ++i) {
    description.actuators.push_back(
        {"rotor_" + std::to_string(i + 1) + "_speed_radps", "rad/s", 0.0, 640.0});
    craft.rotors.push_back(
        {{i == 0 || i == 3 ? arm_m : -arm_m, i < 2 ? arm_m : -arm_m}, i % 2 == 0 ? 1.0 : -1.0});
  }
  craft.inertia_kgm2 = {0.050, 0.050, 0.0977};
  craft.thrust_coefficient_Ns2 = 5.98e-5;
  craft.torque_coefficient_Nms2 = 1.32e-6;
  craft.max_rotor_radps = 640.0;
  craft.rotor_lag_s = 0.05;
  craft.rotor_drag_Ns_per_m = 0.30;
  craft.rotor_radius_m = 0.19;
  craft.tip_radius_m = 0.50;
  craft.max_tilt_rad = rad_from_deg(25.0);
  craft.landing_speed_limit_mps = 1.0;
  return description;
}

FlightBench::FlightBench(BlockSetup block, PlainScene ground)
    : setup(block), hill(std::move(ground)), map(put_on(make_block(block), hill)) {}

std::unique_ptr<Planner> FlightBench::make() const {
  PlannerContext context;
  context.vehicle = "drone";
  context.part = "drone.planner";
  context.seed = 1;
  context.vehicle_description = &vehicle;
  context.map = &map;
  context.scene = scene;
  const PartSpec& spec = parts().spec(PartKind::kPlanner, "row_flight");
  return parts().make_planner("row_flight", make_parameters(spec, values), context);
}

Result<PlannedPath> FlightBench::plan(double x, double y, double yaw_rad) {
  planner = make();
  const Eigen::Vector2d p = block_point(setup, x, y);
  return planner->plan({quaternion_from_rpy({0.0, 0.0, yaw_rad}),
                        {p.x(), p.y(), hill.ground_m(p) + vehicle.height_above_ground_m}});
}

std::vector<PlanSample> sample_plan(const PlannedPath& plan, double step_m) {
  std::vector<PlanSample> samples;
  for (std::size_t i = 0; i + 1 < plan.points.size(); ++i) {
    const PathPoint &a = plan.points[i], &b = plan.points[i + 1];
    const Eigen::Vector3d chord = b.p_W - a.p_W;
    const int parts = std::max(1, static_cast<int>(std::ceil(chord.norm() / step_m)));
    const double k = a.curvature_per_m, c = chord.head<2>().norm();
    for (int j = 0; j < parts; ++j) {
      const double share = static_cast<double>(j) / parts;
      Eigen::Vector3d p = a.p_W + share * chord;
      if (k != 0.0) {
        // On the circle through both ends: turned about its centre.
        const Eigen::Vector2d left = Eigen::Vector2d(-chord.y(), chord.x()) / c;
        const Eigen::Vector2d centre =
            0.5 * (a.p_W + b.p_W).head<2>() +
            left * (std::sqrt(1.0 / (k * k) - 0.25 * c * c) * (k > 0.0 ? 1.0 : -1.0));
        const double angle = 2.0 * std::asin(0.5 * k * c) * share;
        p.head<2>() = centre + Eigen::Rotation2Dd(angle) * (a.p_W.head<2>() - centre);
      }
      samples.push_back({p, a.kind});
    }
  }
  if (!plan.points.empty()) samples.push_back({plan.points.back().p_W, plan.points.back().kind});
  return samples;
}

GuideBench::GuideBench(const Values& values, const std::string& type, VehicleDescription vehicle)
    : Loop({.vehicle = "drone", .description = std::move(vehicle), .tick = Duration{50'000'000}}) {
  add_guidance({type, values});
}

void GuideBench::fly(const Eigen::Vector3d& start, double longest_s, double floor_m,
                     const std::function<void(double, const ReferenceTrajectory&)>& each) {
  Odometry estimate;
  estimate.X_WB.p = start;
  while (time_s() < longest_s) {
    const double now_s = time_s();
    const ReferenceTrajectory& reference = step(estimate);
    each(now_s, reference);
    if (reference.phase == Phase::kDone) return;
    const TrajectoryPoint& next = reference.points[1];
    estimate.X_WB.p = next.p_W;
    estimate.X_WB.q = quaternion_from_rpy({0.0, 0.0, next.yaw_rad});
    estimate.v_WB_B = estimate.X_WB.q.conjugate() * next.v_W;
    if (next.p_W.z() < floor_m) {
      estimate.X_WB.p.z() = floor_m;
      estimate.v_WB_B.setZero();
    }
  }
}

}  // namespace vinerow::test
