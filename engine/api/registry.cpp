#include "engine/api/registry.h"

#include <fmt/format.h>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"

namespace vinerow {

const char* to_string(PartKind kind) {
  switch (kind) {
    case PartKind::kWorld:
      return "world";
    case PartKind::kVehicle:
      return "vehicle";
    case PartKind::kMap:
      return "map";
    case PartKind::kSensor:
      return "sensor";
    case PartKind::kEstimator:
      return "estimator";
    case PartKind::kPlanner:
      return "planner";
    case PartKind::kGuidance:
      return "guidance";
    case PartKind::kController:
      return "controller";
    case PartKind::kAutopilot:
      return "autopilot";
    case PartKind::kPayload:
      return "payload";
    case PartKind::kMetric:
      return "metric";
    case PartKind::kJob:
      return "job";
  }
  return "?";
}

template <class Product, class Context>
void Registry::add(PartKind kind, Table<Product, Context>& table, PartSpec spec,
                   PartFactory<Product, Context> make) {
  const std::string name = spec.name;
  const auto existing = table.find(name);
  if (existing != table.end()) {
    throw ConfigError(fmt::format("{} '{}' is registered twice ({}, {})", to_string(kind), name,
                                  existing->second.origin, current_origin_));
  }
  table.emplace(name, Entry<Product, Context>{std::move(spec), current_origin_, std::move(make)});
}

template <class Visitor>
auto Registry::visit(PartKind kind, Visitor&& visitor) const {
  switch (kind) {
    case PartKind::kWorld:
      return visitor(worlds_);
    case PartKind::kVehicle:
      return visitor(vehicles_);
    case PartKind::kMap:
      return visitor(maps_);
    case PartKind::kSensor:
      return visitor(sensors_);
    case PartKind::kEstimator:
      return visitor(estimators_);
    case PartKind::kPlanner:
      return visitor(planners_);
    case PartKind::kGuidance:
      return visitor(guidances_);
    case PartKind::kController:
      return visitor(controllers_);
    case PartKind::kAutopilot:
      return visitor(autopilots_);
    case PartKind::kPayload:
      return visitor(payloads_);
    case PartKind::kJob:
      return visitor(jobs_);
    case PartKind::kMetric:
      break;
  }
  return visitor(metrics_);
}

template <class Product, class Context>
const Registry::Entry<Product, Context>& Registry::find(PartKind kind,
                                                        const Table<Product, Context>& table,
                                                        const std::string& name) const {
  const auto found = table.find(name);
  if (found != table.end()) return found->second;
  const std::vector<std::string> known = names(kind);
  throw ConfigError(fmt::format("unknown {} '{}'{} (known: {})", to_string(kind), name,
                                did_you_mean(name, known), known.empty() ? "none" : join(known)));
}

void Registry::add_world(PartSpec spec, PartFactory<WorldModel, WorldContext> make) {
  add(PartKind::kWorld, worlds_, std::move(spec), std::move(make));
}
void Registry::add_vehicle(PartSpec spec, PartFactory<Vehicle, VehicleContext> make) {
  add(PartKind::kVehicle, vehicles_, std::move(spec), std::move(make));
}
void Registry::add_map(PartSpec spec, PartFactory<RowMap, MapContext> make) {
  add(PartKind::kMap, maps_, std::move(spec), std::move(make));
}
void Registry::add_sensor(PartSpec spec, PartFactory<Sensor, SensorContext> make) {
  add(PartKind::kSensor, sensors_, std::move(spec), std::move(make));
}
void Registry::add_estimator(PartSpec spec, PartFactory<Estimator, EstimatorContext> make) {
  add(PartKind::kEstimator, estimators_, std::move(spec), std::move(make));
}
void Registry::add_planner(PartSpec spec, PartFactory<Planner, PlannerContext> make) {
  add(PartKind::kPlanner, planners_, std::move(spec), std::move(make));
}
void Registry::add_guidance(PartSpec spec, PartFactory<Guidance, ControllerContext> make) {
  add(PartKind::kGuidance, guidances_, std::move(spec), std::move(make));
}
void Registry::add_controller(PartSpec spec, PartFactory<Controller, ControllerContext> make) {
  add(PartKind::kController, controllers_, std::move(spec), std::move(make));
}
void Registry::add_autopilot(PartSpec spec, PartFactory<Autopilot, AutopilotContext> make) {
  add(PartKind::kAutopilot, autopilots_, std::move(spec), std::move(make));
}
void Registry::add_payload(PartSpec spec, PartFactory<Payload, PayloadContext> make) {
  add(PartKind::kPayload, payloads_, std::move(spec), std::move(make));
}
void Registry::add_metric(PartSpec spec, PartFactory<Metric, MetricContext> make) {
  add(PartKind::kMetric, metrics_, std::move(spec), std::move(make));
}
void Registry::add_job(PartSpec spec, PartFactory<Job, JobContext> make) {
  VINEROW_DEMAND(spec.gives.has_value());
  add(PartKind::kJob, jobs_, std::move(spec), std::move(make));
}

std::vector<std::string> Registry::names(PartKind kind) const {
  return visit(kind, [](const auto& table) {
    std::vector<std::string> result;
    for (const auto& [name, entry] : table) result.push_back(name);
    return result;
  });
}

const PartSpec& Registry::spec(PartKind kind, const std::string& name) const {
  return *visit(kind, [&](const auto& table) { return &find(kind, table, name).spec; });
}

const std::string& Registry::origin(PartKind kind, const std::string& name) const {
  return *visit(kind, [&](const auto& table) { return &find(kind, table, name).origin; });
}

std::unique_ptr<WorldModel> Registry::make_world(const std::string& name,
                                                 const ParameterSet& parameters,
                                                 const WorldContext& context) const {
  return find(PartKind::kWorld, worlds_, name).make(parameters, context);
}
std::unique_ptr<Vehicle> Registry::make_vehicle(const std::string& name,
                                                const ParameterSet& parameters,
                                                const VehicleContext& context) const {
  return find(PartKind::kVehicle, vehicles_, name).make(parameters, context);
}
std::unique_ptr<RowMap> Registry::make_map(const std::string& name, const ParameterSet& parameters,
                                           const MapContext& context) const {
  return find(PartKind::kMap, maps_, name).make(parameters, context);
}
std::unique_ptr<Sensor> Registry::make_sensor(const std::string& name,
                                              const ParameterSet& parameters,
                                              const SensorContext& context) const {
  return find(PartKind::kSensor, sensors_, name).make(parameters, context);
}
std::unique_ptr<Estimator> Registry::make_estimator(const std::string& name,
                                                    const ParameterSet& parameters,
                                                    const EstimatorContext& context) const {
  return find(PartKind::kEstimator, estimators_, name).make(parameters, context);
}
std::unique_ptr<Planner> Registry::make_planner(const std::string& name,
                                                const ParameterSet& parameters,
                                                const PlannerContext& context) const {
  return find(PartKind::kPlanner, planners_, name).make(parameters, context);
}
std::unique_ptr<Guidance> Registry::make_guidance(const std::string& name,
                                                  const ParameterSet& parameters,
                                                  const ControllerContext& context) const {
  return find(PartKind::kGuidance, guidances_, name).make(parameters, context);
}
std::unique_ptr<Controller> Registry::make_controller(const std::string& name,
                                                      const ParameterSet& parameters,
                                                      const ControllerContext& context) const {
  return find(PartKind::kController, controllers_, name).make(parameters, context);
}
std::unique_ptr<Autopilot> Registry::make_autopilot(const std::string& name,
                                                    const ParameterSet& parameters,
                                                    const AutopilotContext& context) const {
  return find(PartKind::kAutopilot, autopilots_, name).make(parameters, context);
}
std::unique_ptr<Payload> Registry::make_payload(const std::string& name,
                                                const ParameterSet& parameters,
                                                const PayloadContext& context) const {
  return find(PartKind::kPayload, payloads_, name).make(parameters, context);
}
std::unique_ptr<Job> Registry::make_job(const std::string& name, const ParameterSet& parameters,
                                        const JobContext& context) const {
  return find(PartKind::kJob, jobs_, name).make(parameters, context);
}
std::unique_ptr<Metric> Registry::make_metric(const std::string& name,
                                              const ParameterSet& parameters,
                                              const MetricContext& context) const {
  return find(PartKind::kMetric, metrics_, name).make(parameters, context);
}

}  // namespace vinerow
