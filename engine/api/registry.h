#pragma once
/// Registry of the parts that a scenario can name. register_*.cpp of each folder and plug-ins fill
/// it explicitly.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/job.h"
#include "engine/api/payload.h"
#include "engine/api/stepped_parts.h"

namespace vinerow {

/// Extension points, in the spelling of files and of `vinerow list`.
enum class PartKind {
  kWorld,
  kVehicle,
  kMap,
  kSensor,
  kEstimator,
  kPlanner,
  kGuidance,
  kController,
  kAutopilot,
  kPayload,
  kMetric,
  kJob
};
constexpr PartKind kAllPartKinds[] = {
    PartKind::kWorld,     PartKind::kVehicle, PartKind::kMap,      PartKind::kSensor,
    PartKind::kEstimator, PartKind::kPlanner, PartKind::kGuidance, PartKind::kController,
    PartKind::kAutopilot, PartKind::kPayload, PartKind::kMetric,   PartKind::kJob};
const char* to_string(PartKind kind);

template <class Product, class Context>
using PartFactory = std::function<std::unique_ptr<Product>(const ParameterSet&, const Context&)>;

struct VehicleContext : PartContext {};

class Registry {
 public:
  /// @throws ConfigError if the name is taken: "controller 'pure_pursuit' is registered twice
  /// (built-in, file.so)".
  void add_world(PartSpec spec, PartFactory<WorldModel, WorldContext> make);
  void add_vehicle(PartSpec spec, PartFactory<Vehicle, VehicleContext> make);
  void add_map(PartSpec spec, PartFactory<RowMap, MapContext> make);
  void add_sensor(PartSpec spec, PartFactory<Sensor, SensorContext> make);
  void add_estimator(PartSpec spec, PartFactory<Estimator, EstimatorContext> make);
  void add_planner(PartSpec spec, PartFactory<Planner, PlannerContext> make);
  void add_guidance(PartSpec spec, PartFactory<Guidance, ControllerContext> make);
  void add_controller(PartSpec spec, PartFactory<Controller, ControllerContext> make);
  void add_autopilot(PartSpec spec, PartFactory<Autopilot, AutopilotContext> make);
  void add_payload(PartSpec spec, PartFactory<Payload, PayloadContext> make);
  void add_metric(PartSpec spec, PartFactory<Metric, MetricContext> make);
  /// @pre spec.gives is set
  void add_job(PartSpec spec, PartFactory<Job, JobContext> make);

  /// Names of a kind, sorted.
  std::vector<std::string> names(PartKind kind) const;
  /// @throws ConfigError "unknown controller 'pure_persuit'; did you mean 'pure_pursuit'? (known:
  /// ...)"
  const PartSpec& spec(PartKind kind, const std::string& name) const;
  /// Origin of a part: "built-in" or the plug-in's file.
  const std::string& origin(PartKind kind, const std::string& name) const;

  /// Build a part. Parameters must have passed ParameterSet's checks. @throws ConfigError
  std::unique_ptr<WorldModel> make_world(const std::string& name, const ParameterSet&,
                                         const WorldContext&) const;
  std::unique_ptr<Vehicle> make_vehicle(const std::string& name, const ParameterSet&,
                                        const VehicleContext&) const;
  std::unique_ptr<RowMap> make_map(const std::string& name, const ParameterSet&,
                                   const MapContext&) const;
  std::unique_ptr<Sensor> make_sensor(const std::string& name, const ParameterSet&,
                                      const SensorContext&) const;
  std::unique_ptr<Estimator> make_estimator(const std::string& name, const ParameterSet&,
                                            const EstimatorContext&) const;
  std::unique_ptr<Planner> make_planner(const std::string& name, const ParameterSet&,
                                        const PlannerContext&) const;
  std::unique_ptr<Guidance> make_guidance(const std::string& name, const ParameterSet&,
                                          const ControllerContext&) const;
  std::unique_ptr<Controller> make_controller(const std::string& name, const ParameterSet&,
                                              const ControllerContext&) const;
  std::unique_ptr<Autopilot> make_autopilot(const std::string& name, const ParameterSet&,
                                            const AutopilotContext&) const;
  std::unique_ptr<Payload> make_payload(const std::string& name, const ParameterSet&,
                                        const PayloadContext&) const;
  std::unique_ptr<Metric> make_metric(const std::string& name, const ParameterSet&,
                                      const MetricContext&) const;
  std::unique_ptr<Job> make_job(const std::string& name, const ParameterSet&,
                                const JobContext&) const;

  /// Origin of the parts that are added from now on. Used by the plug-in loader.
  void set_origin(std::string origin) { current_origin_ = std::move(origin); }

 private:
  template <class Product, class Context>
  struct Entry {
    PartSpec spec;
    std::string origin;
    PartFactory<Product, Context> make;
  };
  template <class Product, class Context>
  using Table = std::map<std::string, Entry<Product, Context>>;

  template <class Product, class Context>
  void add(PartKind kind, Table<Product, Context>& table, PartSpec spec,
           PartFactory<Product, Context> make);
  template <class Visitor>
  auto visit(PartKind kind, Visitor&& visitor) const;
  template <class Product, class Context>
  const Entry<Product, Context>& find(PartKind kind, const Table<Product, Context>& table,
                                      const std::string& name) const;

  Table<WorldModel, WorldContext> worlds_;
  Table<Vehicle, VehicleContext> vehicles_;
  Table<RowMap, MapContext> maps_;
  Table<Sensor, SensorContext> sensors_;
  Table<Estimator, EstimatorContext> estimators_;
  Table<Planner, PlannerContext> planners_;
  Table<Guidance, ControllerContext> guidances_;
  Table<Controller, ControllerContext> controllers_;
  Table<Autopilot, AutopilotContext> autopilots_;
  Table<Payload, PayloadContext> payloads_;
  Table<Metric, MetricContext> metrics_;
  Table<Job, JobContext> jobs_;
  std::string current_origin_ = "built-in";
};

}  // namespace vinerow
