#include "engine/api/messages/commands.h"
#include "engine/api/messages/flight.h"
#include "engine/api/messages/sensors.h"
#include "vinerow/testing.h"

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/sim/plugin_loader.h"
#include "engine/sim/simulation.h"
#include "tools/parts/register_all.h"

namespace vinerow::testing {
namespace {

std::shared_ptr<Registry> built_in_registry() {
  auto registry = std::make_shared<Registry>();
  register_all(*registry);
  return registry;
}

}  // namespace

TestRun::TestRun(std::shared_ptr<Registry> registry, std::unique_ptr<Simulation> simulation)
    : registry_(std::move(registry)), simulation_(std::move(simulation)) {}
TestRun::~TestRun() = default;
TestRun::TestRun(TestRun&&) noexcept = default;
TestRun& TestRun::operator=(TestRun&&) noexcept = default;

TestRun TestRun::from_file(const std::filesystem::path& file,
                           const std::vector<std::string>& sets) {
  auto registry = built_in_registry();
  io::Overrides overrides;
  overrides.sets = sets;
  for (const auto& plugin : io::load_plugin_list(file, overrides)) load_plugin(plugin, *registry);
  auto simulation =
      std::make_unique<Simulation>(io::load_scenario(file, *registry, overrides), *registry);
  return TestRun(std::move(registry), std::move(simulation));
}

TestRun TestRun::from_yaml(const std::string& yaml, const std::filesystem::path& folder) {
  auto registry = built_in_registry();
  auto simulation =
      std::make_unique<Simulation>(io::parse_scenario(yaml, folder, *registry), *registry);
  return TestRun(std::move(registry), std::move(simulation));
}

TestRun& TestRun::run_for_s(double duration_s) {
  // now() is the next instant to be worked on, so the last one inside the span is one step earlier.
  simulation_->run_until(simulation_->now() + duration_from_s(duration_s) -
                         simulation_->scenario().physics_step);
  return *this;
}

TestRun& TestRun::run_to_end() {
  simulation_->run();
  return *this;
}

double TestRun::time_s() const {
  return simulation_->now().s();
}
bool TestRun::finished() const {
  return simulation_->finished();
}
const Odometry& TestRun::truth(const std::string& vehicle) const {
  return simulation_->truth(vehicle);
}
std::string TestRun::digest() const {
  return simulation_->digest();
}
Simulation& TestRun::simulation() {
  return *simulation_;
}

std::map<std::string, double> TestRun::metrics(const std::string& vehicle) const {
  static_cast<void>(truth(vehicle));  // says which vehicles there are
  return simulation_->metrics().at(vehicle);
}

double TestRun::metric(const std::string& vehicle, const std::string& name) const {
  const auto all = metrics(vehicle);
  const auto found = all.find(name);
  if (found != all.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [key, value] : all) known.push_back(key);
  throw ConfigError(fmt::format("vehicle '{}' has no metric '{}'{} (known: {})", vehicle, name,
                                did_you_mean(name, known), join(known)));
}

template <class T>
const T& TestRun::signal(const std::string& name) const {
  std::vector<std::string> known;
  for (const auto& signal : simulation_->bus().signals()) known.push_back(signal->name());
  const SignalBase* signal = simulation_->bus().find(name);
  if (!signal) {
    throw ConfigError(
        fmt::format("no signal '{}'{} (known: {})", name, did_you_mean(name, known), join(known)));
  }
  const auto* typed = dynamic_cast<const Signal<T>*>(signal);
  if (!typed)
    throw ConfigError(fmt::format("signal '{}' is {}, not {}", name, signal->type(), T::kType));
  if (typed->sequence() == 0)
    throw ConfigError(fmt::format("signal '{}' has not been written yet", name));
  return typed->value();
}

template const Odometry& TestRun::signal<Odometry>(const std::string&) const;
template const ImuSample& TestRun::signal<ImuSample>(const std::string&) const;
template const GnssFix& TestRun::signal<GnssFix>(const std::string&) const;
template const RangeSample& TestRun::signal<RangeSample>(const std::string&) const;
template const VelocityCommand& TestRun::signal<VelocityCommand>(const std::string&) const;
template const NamedValues& TestRun::signal<NamedValues>(const std::string&) const;
template const LinkPoses& TestRun::signal<LinkPoses>(const std::string&) const;
template const PlannedPath& TestRun::signal<PlannedPath>(const std::string&) const;
template const LocalCommand& TestRun::signal<LocalCommand>(const std::string&) const;
template const LineList& TestRun::signal<LineList>(const std::string&) const;
template const OccupancyGrid& TestRun::signal<OccupancyGrid>(const std::string&) const;
template const FollowerState& TestRun::signal<FollowerState>(const std::string&) const;
template const ReferenceTrajectory& TestRun::signal<ReferenceTrajectory>(const std::string&) const;
template const AirReference& TestRun::signal<AirReference>(const std::string&) const;
template const MovementAuthority& TestRun::signal<MovementAuthority>(const std::string&) const;
template const BatteryState& TestRun::signal<BatteryState>(const std::string&) const;
template const Event& TestRun::signal<Event>(const std::string&) const;

namespace {

struct VehicleText {
  std::string name, type, parameters, sensors, estimator, planner, controller;
};

std::string part_text(const std::string& type, const std::string& parameters) {
  return fmt::format("{{type: {}{}{}}}", type, parameters.empty() ? "" : ", ", parameters);
}

}  // namespace

struct SmallWorld::Impl {
  std::string world;
  std::vector<VehicleText> vehicles;
  std::vector<std::filesystem::path> plugins;
  std::vector<std::pair<PartSpec, PartFactory<Controller, ControllerContext>>> controllers;
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

SmallWorld& SmallWorld::vehicle(const std::string& name, const std::string& type,
                                const std::string& parameters) {
  impl_->vehicles.push_back({name, type, parameters, "", "", "", ""});
  return *this;
}

SmallWorld& SmallWorld::sensor(const std::string& vehicle, const std::string& name,
                               const std::string& type, const std::string& parameters) {
  std::string& sensors = impl_->find(vehicle).sensors;
  sensors +=
      fmt::format("{}{}: {}", sensors.empty() ? "" : ", ", name, part_text(type, parameters));
  return *this;
}

SmallWorld& SmallWorld::estimator(const std::string& vehicle, const std::string& type,
                                  const std::string& parameters) {
  impl_->find(vehicle).estimator = part_text(type, parameters);
  return *this;
}

SmallWorld& SmallWorld::planner(const std::string& vehicle, const std::string& type,
                                const std::string& parameters) {
  impl_->find(vehicle).planner = part_text(type, parameters);
  return *this;
}

SmallWorld& SmallWorld::controller(const std::string& vehicle, const std::string& type,
                                   const std::string& parameters) {
  impl_->find(vehicle).controller = part_text(type, parameters);
  return *this;
}

SmallWorld& SmallWorld::controller(const std::string& vehicle, PartSpec spec,
                                   PartFactory<Controller, ControllerContext> make,
                                   const std::string& parameters) {
  impl_->find(vehicle).controller = part_text(spec.name, parameters);
  impl_->controllers.emplace_back(std::move(spec), std::move(make));
  return *this;
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
  for (const VehicleText& vehicle : impl_->vehicles) {
    std::string inside = fmt::format("type: {}", vehicle.type);
    if (vehicle.parameters.find("spawn:") == std::string::npos) inside += ", spawn: {alley: 0}";
    const auto append = [&](const std::string& key, const std::string& value) {
      if (!value.empty()) inside += fmt::format(", {}{}", key, value);
    };
    append("", vehicle.parameters);
    if (!vehicle.sensors.empty()) append("sensors: ", "{" + vehicle.sensors + "}");
    append("estimator: ", vehicle.estimator);
    append("planner: ", vehicle.planner);
    append("controller: ", vehicle.controller);
    text += fmt::format("  {}: {{{}}}\n", vehicle.name, inside);
  }
  return text;
}

TestRun SmallWorld::build() const {
  auto registry = built_in_registry();
  for (const auto& plugin : impl_->plugins) load_plugin(plugin, *registry);
  for (const auto& [spec, make] : impl_->controllers) registry->add_controller(spec, make);
  auto simulation = std::make_unique<Simulation>(
      io::parse_scenario(yaml(), std::filesystem::current_path(), *registry), *registry);
  return TestRun(std::move(registry), std::move(simulation));
}

}  // namespace vinerow::testing
