#pragma once
/// Parts for tests of the kernel: level ground with a map, a vehicle that stands, a planner that
/// reports, a controller that writes events.

#include <memory>

#include "engine/api/height_field.h"
#include "engine/api/map.h"
#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/registry.h"
#include "engine/api/world_model.h"
#include "tests/support/spec_makers.h"

namespace vinerow::test {

inline std::unique_ptr<WorldModel> make_plain(const ParameterSet& parameters, const WorldContext&) {
  auto world = std::make_unique<WorldModel>();
  world->name = "plain";
  HeightField ground;
  ground.columns = ground.rows = 3;
  ground.cell_m = 10.0;
  ground.corner_W = {-10, -10};
  ground.heights_m.assign(9, 0.0f);
  world->terrain = ground;
  if (parameters.boolean("has_map")) {
    OccupancyGrid& grid = world->rows->occupancy;
    grid.columns = 3;
    grid.rows = 2;
    grid.cell_m = 0.5;
    grid.corner_W = {1, 2};
    grid.cells = {0, 1, 0, 1, 1, 0};
  }
  return world;
}

/// A row mesh of one triangle.
inline std::unique_ptr<RowMap> make_one_sheet(const ParameterSet& parameters, const MapContext&) {
  auto map = std::make_unique<RowMap>();
  if (!parameters.boolean("has_meshes")) return map;
  RowMesh row;
  row.mesh_W.vertices = {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}};
  row.mesh_W.triangles = {{0, 1, 2}};
  map->meshes.push_back(row);
  return map;
}

/// Stands where it was put, and is wrecked from `crash_s` on where that is given.
class Statue final : public Vehicle {
 public:
  explicit Statue(double crash_s = 0.0, bool flies = false) : crash_s_(crash_s) {
    description_.type = "statue";
    if (flies) description_.rotorcraft.emplace();
  }
  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld&, const Pose& X_WB) override { X_WB_ = X_WB; }
  void connect(Ports&) override {}
  void actuate(std::span<const double>) override {}
  void before_physics(Time, Duration) override {}
  void after_physics(Time now, Duration) override {
    crashed_ = crashed_ || (crash_s_ > 0.0 && now.s() >= crash_s_);
  }
  std::string_view crash() const override {
    return crashed_ ? "hit the ground at 2.3 m/s" : std::string_view();
  }
  void read_truth(Odometry& truth) const override { truth.X_WB = X_WB_; }
  Eigen::Vector3d specific_force_B() const override { return {0, 0, 9.8}; }
  void read_links(std::vector<Pose>&) const override {}
  void publish(Time) override {}

 private:
  VehicleDescription description_;
  std::vector<VehicleLink> links_;
  Pose X_WB_;
  double crash_s_;
  bool crashed_ = false;
};

/// A straight path of 2 m, and a tree of one branch where `reports` says so.
class StraightAhead final : public Planner {
 public:
  explicit StraightAhead(const ParameterSet& parameters)
      : reports_(parameters.boolean("reports")), refuses_(parameters.boolean("refuses")) {
    report_.numbers = {{"nodes", 42.0}, {"clearance_m", 0.25}};
    report_.tree.points_W = {{0, 0, 0}, {1, 0, 0}};
  }
  Result<PlannedPath> plan(const Pose& start) override {
    if (refuses_) return Failure{"there is no way"};
    PlannedPath path;
    path.points.resize(2);
    path.points[0].p_W = start.p;
    path.points[1].p_W = start.p + Eigen::Vector3d(2, 0, 0);
    path.length_m = 2.0;
    return path;
  }
  const PlanReport* report() const override { return reports_ ? &report_ : nullptr; }

 private:
  bool reports_;
  bool refuses_;
  PlanReport report_;
};

/// If `tells` is set, writes an event of its own at 0.1 s and one with another source at 0.3 s.
/// If `finish_s` is given, it has finished from then on and reports that as a follower.
class EventReporter final : public Controller {
 public:
  explicit EventReporter(const ParameterSet& parameters)
      : reports_events_(parameters.boolean("tells")), finish_s_(parameters.number("finish_s")) {}
  void connect(Ports& ports) override {
    plan_ = ports.read_optional<PlannedPath>("plan");
    actuators_ = ports.write<NamedValues>("actuators");
    event_ = ports.write<Event>("controller_event");
    if (finish_s_ > 0.0) follower_ = ports.write<FollowerState>("follower");
  }
  bool finished() const override { return finished_; }
  void step(Time now) override {
    finished_ = finish_s_ > 0.0 && now.s() >= finish_s_;
    if (finished_) follower_.write(now, {.finished = true});
    if (!reports_events_) return;
    if (now.ns == 100'000'000) event_.write(now, {Event::Level::kWarning, "", "blocked"});
    if (now.ns == 300'000'000) event_.write(now, {Event::Level::kInfo, "rover.dwa", "goes on"});
  }

 private:
  bool reports_events_;
  double finish_s_;
  bool finished_ = false;
  SignalReader<PlannedPath> plan_;
  SignalWriter<NamedValues> actuators_;
  SignalWriter<Event> event_;
  SignalWriter<FollowerState> follower_;
};

inline Registry small_registry() {
  const auto spec = [](const char* name, std::vector<ParameterSpec> parameters) {
    PartSpec result;
    result.name = name;
    result.description = "for tests";
    result.parameters = std::move(parameters);
    return result;
  };
  Registry registry;
  registry.add_world(
      spec("plain", {boolean_parameter("has_map", false, "whether it has an occupancy grid")}),
      make_plain);
  registry.add_vehicle(
      spec("statue", {number_parameter("crash_s", "s", 0.0, 0.0, 1e3, "wrecked from then on")}),
      [](const ParameterSet& parameters, const VehicleContext&) {
        return std::make_unique<Statue>(parameters.number("crash_s"));
      });
  registry.add_map(
      spec("one_sheet", {boolean_parameter("has_meshes", true, "whether it has row meshes")}),
      make_one_sheet);
  registry.add_planner(
      spec("straight_ahead", {boolean_parameter("reports", true, "whether it keeps a report"),
                              boolean_parameter("refuses", false, "whether it finds no path")}),
      [](const ParameterSet& parameters, const PlannerContext&) {
        return std::make_unique<StraightAhead>(parameters);
      });
  registry.add_controller(
      spec("teller", {boolean_parameter("tells", true, "whether it writes events"),
                      number_parameter("finish_s", "s", 0.0, 0.0, 1e3, "finished from then on")}),
      [](const ParameterSet& parameters, const ControllerContext&) {
        return std::make_unique<EventReporter>(parameters);
      });
  return registry;
}

}  // namespace vinerow::test
