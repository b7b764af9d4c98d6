/// Map and planner of a vehicle. Part of VehicleRuntime.

#include <fmt/format.h>

#include "engine/api/map.h"
#include "engine/api/outside.h"
#include "engine/core/error.h"
#include "engine/sim/vehicle_parts.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow {

std::shared_ptr<const RowMap> VehicleRuntime::make_map() const {
  if (!config_.map) return nullptr;
  auto map_context = context<MapContext>(config_.name + ".map", 0.0);
  map_context.world = &run_.world;
  map_context.scene = &run_.physics.scene();
  return run_.registry.make_map(config_.map->type, config_.map->parameters, map_context);
}

void VehicleRuntime::take_map(std::shared_ptr<const RowMap> map) {
  map_ground_.reset();
  own_map_ = std::move(map);
  if (!own_map_) return;
  if (own_map_->terrain) map_ground_.emplace(*own_map_->terrain);
}

void VehicleRuntime::show_map() {
  if (!own_map_ || own_map_->meshes.empty()) return;
  map_edges_writer_ =
      Ports(run_.bus, config_.name, config_.name + ".map").write<LineList>("map_edges");
  map_edges_due_ = begin_.has_value();
  add_diagnostic(config_.name + "/map_edges");
}

PlannerContext VehicleRuntime::planner_context() const {
  auto result = context<PlannerContext>(config_.name + ".planner", control_rate_Hz());
  result.vehicle_description = &vehicle_->description();
  result.map = &map();
  result.scene =
      map_ground_ ? static_cast<const SceneQuery*>(&*map_ground_) : &run_.physics.scene();
  result.origin = run_.world.origin;
  return result;
}

void VehicleRuntime::add_planner() {
  if (!config_.planner && !handover_.plan) return;
  const std::string part = config_.name + ".planner";
  if (!handover_.plan) {
    planner_ = with_place(config_.planner->where, config_.name, [&] {
      return run_.registry.make_planner(config_.planner->type, config_.planner->parameters,
                                        planner_context());
    });
  }
  Ports ports(run_.bus, config_.name, part);
  estimate_ = ports.read<Odometry>("estimate");
  plan_writer_ = ports.write<PlannedPath>("plan");
  tree_writer_ = ports.write<LineList>("plan_tree");
  add_diagnostic(config_.name + "/plan_tree");
  schedule(Stage::kPlan, part, period_of_rate(control_rate_Hz()), {},
           [this](Time now) { try_to_plan(now); });
}

Result<PlannedPath> VehicleRuntime::plan_ahead(std::shared_ptr<const RowMap> map) {
  if (!config_.planner) {
    return Failure{fmt::format("vehicle '{}' has no planner", config_.name)};
  }
  // This map is used for this plan only and does not replace the vehicle's own map.
  const std::shared_ptr<const RowMap> kept = own_map_;
  take_map(map ? std::move(map) : make_map());
  Result<PlannedPath> plan = Failure{};
  try {
    const auto planner = run_.registry.make_planner(config_.planner->type,
                                                    config_.planner->parameters, planner_context());
    plan = planner->plan(truth_.X_WB);
  } catch (const ConfigError& error) {
    plan = Failure{error.what()};
  }
  take_map(kept);
  return plan;
}

void VehicleRuntime::try_to_plan(Time now) {
  if (planned_ || !plan_failure_.empty() || !estimate_.has_value()) return;
  Result<PlannedPath> plan = Failure{};
  if (handover_.plan) {
    plan = *handover_.plan;
  } else {
    guarded(config_.name + ".planner", config_.planner->type,
            [&](Time) { plan = planner_->plan(estimate_.value().X_WB); })(now);
  }
  if (!plan && !run_.scenario.phases.empty()) {
    plan_failure_ =
        fmt::format("{}.planner ({}): {}", config_.name, config_.planner->type, plan.reason());
    return;
  }
  // A failed plan is bad input, not an error of the simulation.
  if (!plan) {
    throw ConfigError(fmt::format("{}: {}.planner ({}): {}", config_.planner->where.text(),
                                  config_.name, config_.planner->type, plan.reason()));
  }
  planned_ = true;
  plan_writer_.write(now, *plan);
  std::string told =
      fmt::format("planned {:.2f} m with {} points", plan->length_m, plan->points.size());
  if (const PlanReport* report = planner_ ? planner_->report() : nullptr) {
    plan_numbers_ = report->numbers;
    if (!report->tree.points_W.empty()) tree_writer_.write(now, report->tree);
    // Some planners report dozens of numbers, too many for a sentence.
    if (!report->numbers.empty()) {
      told += fmt::format("; its numbers are in summary.json, planning.{}", config_.name);
    }
  }
  run_.emit(Event::Level::kInfo, config_.name + ".planner", told);
}

void VehicleRuntime::refuse_a_missing_plan() const {
  const SignalBase* plan = run_.bus.find(config_.name + "/plan");
  if (planner_ || handover_.plan || plan == nullptr || plan->writer() == kOutside) return;
  const auto refuse = [&](const scenario::PartConfig& part, const std::string& name) {
    if (plan->first_reader() != name) return;
    throw ConfigError(fmt::format("{}: {}: '{}' follows a plan, but the vehicle has no planner",
                                  part.where.text(), name, part.type));
  };
  if (config_.guidance) refuse(*config_.guidance, config_.name + ".guidance");
  refuse(*config_.controller, config_.name + ".controller");
}

}  // namespace vinerow
