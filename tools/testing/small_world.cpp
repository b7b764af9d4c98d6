#include <fmt/format.h>

#include <functional>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/scenario/scenario.h"
#include "engine/sim/plugin_loader.h"
#include "tools/parts/register_all.h"
#include "vinerow/testing.h"

namespace vinerow::testing {
namespace {

/// Joins two lists of keys: "a", "b: c" -> "a, b: c"; either may be empty.
std::string joined(const std::string& first, const std::string& second) {
  return first + (first.empty() || second.empty() ? "" : ", ") + second;
}

std::string part_text(const std::string& type, const std::string& parameters) {
  return "{" + joined("type: " + type, parameters) + "}";
}

void add_named(std::string& parts, const std::string& name, const std::string& text) {
  parts = joined(parts, name + ": " + text);
}

}  // namespace

struct SmallWorld::Impl {
  struct VehicleText {
    std::string name, type, parameters;
    std::string map, sensors, estimator, observers, planner, guidance, controller, payloads;
  };
  std::string world;
  std::vector<VehicleText> vehicles;
  std::string phases;
  std::vector<std::filesystem::path> plugins;
  /// Functions that register the parts given as spec and factory, in the order of the calls.
  std::vector<std::function<void(Registry&)>> parts;
  std::uint64_t seed = 1;
  double physics_step_s = 0.001;
  double duration_s = 600.0;

  VehicleText& find(const std::string& name) {
    std::vector<std::string> known;
    for (VehicleText& vehicle : vehicles) {
      if (vehicle.name == name) return vehicle;
      known.push_back(vehicle.name);
    }
    throw ConfigError(fmt::format("no vehicle '{}'; add it with vehicle(...) first (known: {})",
                                  name, known.empty() ? "none" : join(known)));
  }

  /// Stores a custom part for the registry. @param add  e.g. &Registry::add_sensor
  /// @returns its type
  template <class Factory>
  std::string keep(void (Registry::*add)(PartSpec, Factory), PartSpec spec, Factory make) {
    std::string type = spec.name;
    parts.push_back([add, spec = std::move(spec), make = std::move(make)](Registry& registry) {
      (registry.*add)(spec, make);
    });
    return type;
  }
};

SmallWorld::SmallWorld() : impl_(std::make_unique<Impl>()) {
  world("vineyard",
        "row_count: 2, row_length_m: 20, relief_m: 0, waves_m: 0, leaf_cards_per_m: 10, "
        "plant_variants: 1");
}
SmallWorld::~SmallWorld() = default;
SmallWorld::SmallWorld(SmallWorld&&) noexcept = default;
SmallWorld& SmallWorld::operator=(SmallWorld&&) noexcept = default;

SmallWorld& SmallWorld::world(const std::string& type, const std::string& parameters) {
  impl_->world = part_text(type, parameters);
  return *this;
}

SmallWorld& SmallWorld::world(PartSpec spec, PartFactory<WorldModel, WorldContext> make,
                              const std::string& parameters) {
  return world(impl_->keep(&Registry::add_world, std::move(spec), std::move(make)), parameters);
}

SmallWorld& SmallWorld::vehicle(const std::string& name, const std::string& type,
                                const std::string& parameters) {
  Impl::VehicleText& vehicle = impl_->vehicles.emplace_back();
  vehicle.name = name;
  vehicle.type = type;
  vehicle.parameters = parameters;
  return *this;
}

SmallWorld& SmallWorld::vehicle(const std::string& name, PartSpec spec,
                                PartFactory<Vehicle, VehicleContext> make,
                                const std::string& parameters) {
  return vehicle(name, impl_->keep(&Registry::add_vehicle, std::move(spec), std::move(make)),
                 parameters);
}

SmallWorld& SmallWorld::map(const std::string& vehicle, const std::string& type,
                            const std::string& parameters) {
  impl_->find(vehicle).map = part_text(type, parameters);
  return *this;
}

SmallWorld& SmallWorld::map(const std::string& vehicle, PartSpec spec,
                            PartFactory<RowMap, MapContext> make, const std::string& parameters) {
  return map(vehicle, impl_->keep(&Registry::add_map, std::move(spec), std::move(make)),
             parameters);
}

SmallWorld& SmallWorld::sensor(const std::string& vehicle, const std::string& name,
                               const std::string& type, const std::string& parameters) {
  add_named(impl_->find(vehicle).sensors, name, part_text(type, parameters));
  return *this;
}

SmallWorld& SmallWorld::sensor(const std::string& vehicle, const std::string& name, PartSpec spec,
                               PartFactory<Sensor, SensorContext> make,
                               const std::string& parameters) {
  return sensor(vehicle, name,
                impl_->keep(&Registry::add_sensor, std::move(spec), std::move(make)), parameters);
}

SmallWorld& SmallWorld::estimator(const std::string& vehicle, const std::string& type,
                                  const std::string& parameters) {
  impl_->find(vehicle).estimator = part_text(type, parameters);
  return *this;
}

SmallWorld& SmallWorld::estimator(const std::string& vehicle, PartSpec spec,
                                  PartFactory<Estimator, EstimatorContext> make,
                                  const std::string& parameters) {
  return estimator(vehicle,
                   impl_->keep(&Registry::add_estimator, std::move(spec), std::move(make)),
                   parameters);
}

SmallWorld& SmallWorld::observer(const std::string& vehicle, const std::string& name,
                                 const std::string& type, const std::string& parameters) {
  add_named(impl_->find(vehicle).observers, name, part_text(type, parameters));
  return *this;
}

SmallWorld& SmallWorld::observer(const std::string& vehicle, const std::string& name,
                                 PartSpec spec, PartFactory<Estimator, EstimatorContext> make,
                                 const std::string& parameters) {
  return observer(vehicle, name,
                  impl_->keep(&Registry::add_estimator, std::move(spec), std::move(make)),
                  parameters);
}

SmallWorld& SmallWorld::planner(const std::string& vehicle, const std::string& type,
                                const std::string& parameters) {
  impl_->find(vehicle).planner = part_text(type, parameters);
  return *this;
}

SmallWorld& SmallWorld::planner(const std::string& vehicle, PartSpec spec,
                                PartFactory<Planner, PlannerContext> make,
                                const std::string& parameters) {
  return planner(vehicle, impl_->keep(&Registry::add_planner, std::move(spec), std::move(make)),
                 parameters);
}

SmallWorld& SmallWorld::guidance(const std::string& vehicle, const std::string& type,
                                 const std::string& parameters) {
  impl_->find(vehicle).guidance = part_text(type, parameters);
  return *this;
}

SmallWorld& SmallWorld::guidance(const std::string& vehicle, PartSpec spec,
                                 PartFactory<Guidance, ControllerContext> make,
                                 const std::string& parameters) {
  return guidance(vehicle, impl_->keep(&Registry::add_guidance, std::move(spec), std::move(make)),
                  parameters);
}

SmallWorld& SmallWorld::controller(const std::string& vehicle, const std::string& type,
                                   const std::string& parameters) {
  impl_->find(vehicle).controller = part_text(type, parameters);
  return *this;
}

SmallWorld& SmallWorld::controller(const std::string& vehicle, PartSpec spec,
                                   PartFactory<Controller, ControllerContext> make,
                                   const std::string& parameters) {
  return controller(vehicle,
                    impl_->keep(&Registry::add_controller, std::move(spec), std::move(make)),
                    parameters);
}

SmallWorld& SmallWorld::payload(const std::string& vehicle, const std::string& name,
                                const std::string& type, const std::string& parameters) {
  add_named(impl_->find(vehicle).payloads, name, part_text(type, parameters));
  return *this;
}

SmallWorld& SmallWorld::payload(const std::string& vehicle, const std::string& name, PartSpec spec,
                                PartFactory<Payload, PayloadContext> make,
                                const std::string& parameters) {
  return payload(vehicle, name,
                 impl_->keep(&Registry::add_payload, std::move(spec), std::move(make)),
                 parameters);
}

SmallWorld& SmallWorld::metric(PartSpec spec, PartFactory<Metric, MetricContext> make) {
  impl_->keep(&Registry::add_metric, std::move(spec), std::move(make));
  return *this;
}

SmallWorld& SmallWorld::phase(const std::string& name, const std::vector<std::string>& vehicles,
                              const std::string& keys) {
  const std::string work = "vehicles: [" + join(vehicles) + "]";
  impl_->phases += fmt::format("  {}: {{{}}}\n", name, joined(work, keys));
  return *this;
}

SmallWorld& SmallWorld::job(const std::string& phase, const std::string& type,
                            const std::string& parameters, const std::string& keys) {
  const std::string work = "job: " + part_text(type, parameters);
  impl_->phases += fmt::format("  {}: {{{}}}\n", phase, joined(work, keys));
  return *this;
}

SmallWorld& SmallWorld::job(const std::string& phase, PartSpec spec,
                            PartFactory<Job, JobContext> make, const std::string& parameters,
                            const std::string& keys) {
  return job(phase, impl_->keep(&Registry::add_job, std::move(spec), std::move(make)), parameters,
             keys);
}

SmallWorld& SmallWorld::plugin(const std::filesystem::path& file) {
  impl_->plugins.push_back(file);
  return *this;
}

SmallWorld& SmallWorld::seed(std::uint64_t value) {
  impl_->seed = value;
  return *this;
}

SmallWorld& SmallWorld::physics_step_s(double step_s) {
  impl_->physics_step_s = step_s;
  return *this;
}

SmallWorld& SmallWorld::duration_s(double value) {
  impl_->duration_s = value;
  return *this;
}

std::string SmallWorld::yaml() const {
  std::string text = fmt::format(
      "vinerow: 1\nname: small_world\nseed: {}\nduration_s: {}\nphysics: {{step_s: {}}}\n",
      impl_->seed, impl_->duration_s, impl_->physics_step_s);
  text += fmt::format("world: {}\nvehicles:\n", impl_->world);
  for (const Impl::VehicleText& vehicle : impl_->vehicles) {
    std::string inside = "type: " + vehicle.type;
    if (vehicle.parameters.find("spawn:") == std::string::npos) inside += ", spawn: {alley: 0}";
    inside = joined(inside, vehicle.parameters);
    const auto append = [&](const std::string& key, const std::string& value) {
      if (!value.empty()) add_named(inside, key, value);
    };
    const auto append_named_parts = [&](const std::string& key, const std::string& parts) {
      if (!parts.empty()) append(key, "{" + parts + "}");
    };
    append("map", vehicle.map);
    append_named_parts("sensors", vehicle.sensors);
    append("estimator", vehicle.estimator);
    append_named_parts("observers", vehicle.observers);
    append("planner", vehicle.planner);
    append("guidance", vehicle.guidance);
    append("controller", vehicle.controller);
    append_named_parts("payloads", vehicle.payloads);
    text += fmt::format("  {}: {{{}}}\n", vehicle.name, inside);
  }
  if (!impl_->phases.empty()) text += "phases:\n" + impl_->phases;
  return text;
}

TestRun SmallWorld::build() const {
  auto registry = std::make_shared<Registry>();
  register_all(*registry);
  for (const auto& plugin : impl_->plugins) load_plugin(plugin, *registry);
  for (const auto& add : impl_->parts) add(*registry);
  const scenario::Scenario scenario =
      scenario::parse_scenario(yaml(), std::filesystem::current_path(), *registry);
  return TestRun(Session(scenario, std::move(registry)));
}

}  // namespace vinerow::testing
