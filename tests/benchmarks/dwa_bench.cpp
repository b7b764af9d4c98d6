/// One tick of guidance `dwa` in an alley of 2.5 m, between plants 0.6 m wide; budget 1 ms.

#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>

#include "controllers/dwa/dwa.h"
#include "engine/api/map.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/grid.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/vehicle.h"
#include "engine/api/world_model.h"
#include "engine/math/angles.h"

namespace vinerow::dwa_bench {
namespace {

VehicleDescription make_vehicle() {
  VehicleDescription vehicle;
  vehicle.type = "rover";
  vehicle.footprint_B = {{-0.95, -0.36}, {-0.75, -0.5}, {0.75, -0.5}, {0.95, -0.36},
                         {0.95, 0.36},   {0.75, 0.5},   {-0.75, 0.5}, {-0.95, 0.36}};
  vehicle.height_above_ground_m = 1.0;
  vehicle.max_speed_mps = 1.6;
  vehicle.wheeled.emplace();
  vehicle.steered = {.front_axle_m = 0.75,
                     .rear_axle_m = 0.75,
                     .max_axle_steer_rad = rad_from_deg(23),
                     .steer_rate_radps = 2.0};
  return vehicle;
}

RowMap make_alley_map() {
  RowMap map;
  OccupancyGrid& grid = map.occupancy;
  grid.cell_m = 0.05;
  grid.corner_W = {-10.0, -25.0};
  grid.columns = 2800;  // 140 x 50 m, as the parcel
  grid.rows = 1000;
  for (int j = 0; j < grid.rows; ++j) {
    const double y = std::remainder(-25.0 + 0.05 * (j + 0.5) - 1.25, 2.5);
    for (int i = 0; i < grid.columns; ++i) grid.cells.push_back(std::abs(y) < 0.3 ? 1 : 0);
  }
  return map;
}

/// @param footprint  0 circles, 1 polygon  @param seen  something stands 1.2 m ahead of the nose
void dwa_tick(benchmark::State& state, bool pure, bool polygon, bool with_obstacle) {
  const VehicleDescription vehicle = make_vehicle();
  const RowMap map = make_alley_map();
  ControllerContext context;
  context.part = "rover.guidance";
  context.vehicle_description = &vehicle;
  context.map = &map;
  for (const double y : {0.15, -0.15}) {
    context.sensors.push_back(
        {y > 0 ? "left" : "right", "ultrasound", {Eigen::Quaterniond::Identity(), {0.95, y, 0.0}}});
  }
  ParameterSet parameters(controllers::dwa_spec().parameters, "dwa");
  parameters.set("mode", std::string(pure ? "pure" : "assist"));
  parameters.set("footprint", std::string(polygon ? "polygon" : "circles"));
  const auto guidance = controllers::make_dwa(parameters, context);
  SignalBus bus;
  Ports world(bus, "rover", "bench");
  auto estimate = world.write<Odometry>("estimate");
  auto plan = world.write<PlannedPath>("plan");
  std::vector<SignalWriter<RangeSample>> ranges;
  for (const auto& sensor : context.sensors)
    ranges.push_back(world.write<RangeSample>(sensor.name));
  Ports ports(bus, "rover", "rover.guidance");
  guidance->connect(ports);
  const auto command = world.read<LocalCommand>("local_command");
  PlannedPath path;
  for (int i = 0; i <= 400; ++i) {
    PathPoint point;
    point.p_W = {0.25 * i, 0.0, 0.0};
    path.points.push_back(point);
  }
  plan.write(Time{}, path);
  std::int64_t i = 0;
  double drives = 0;
  for (auto _ : state) {
    const Time now{i * 100'000'000};
    Odometry odometry;
    // Along the alley 5 cm a tick, so that it never counts as jammed.
    odometry.X_WB.p = {1.0 + 0.05 * static_cast<double>(i % 1000), 0.05, 0.0};
    odometry.v_WB_B.x() = 0.5;
    if (i % 1000 == 0) plan.write(now, path);
    ++i;
    estimate.write(now, odometry);
    for (auto& range : ranges) {
      RangeSample sample;
      sample.range_m = with_obstacle ? 1.2 : std::numeric_limits<double>::infinity();
      sample.max_range_m = 4.0;
      sample.half_angle_rad = rad_from_deg(15);
      range.write(now, sample);
    }
    guidance->step(now);
    drives += command.value().mode == LocalCommand::Mode::kDrive;
  }
  state.counters["drive_share"] = drives / static_cast<double>(state.iterations());
}

BENCHMARK_CAPTURE(dwa_tick, follow, false, false, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(dwa_tick, pure, true, false, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(dwa_tick, obstacle, false, false, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(dwa_tick, pure_obstacle, true, false, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(dwa_tick, pure_polygon, true, true, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(dwa_tick, pure_polygon_obstacle, true, true, true)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace vinerow::dwa_bench
