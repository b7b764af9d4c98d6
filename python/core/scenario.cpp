#include "python/core/scenario.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "engine/core/error.h"
#include "engine/sim/plugin_loader.h"
#include "python/core/arguments.h"
#include "python/core/yaml_from_python.h"
#include "tools/parts/register_all.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

using Values = Typed<"dict[str, typing.Any]">;

std::shared_ptr<LoadedScenario> load_file(const PathArgument& path, const Values& values,
                                          const std::vector<std::string>& sets,
                                          std::optional<std::uint64_t> seed) {
  const std::filesystem::path file = path.value("source");
  const scenario::Overrides overrides = overrides_from_python(values, sets, seed);
  auto registry = registry_with(scenario::load_plugin_list(file, overrides));
  scenario::Scenario scenario = scenario::load_scenario(file, *registry, overrides);
  return std::make_shared<LoadedScenario>(LoadedScenario{std::move(scenario), std::move(registry)});
}

std::shared_ptr<LoadedScenario> load_tree(const Values& tree, const PathArgument& folder,
                                          const Values& values,
                                          const std::vector<std::string>& sets,
                                          std::optional<std::uint64_t> seed) {
  const scenario::Overrides overrides = overrides_from_python(values, sets, seed);
  const io::YamlNode root = yaml_from_python(tree, "");
  const std::filesystem::path start = folder.value("folder");
  auto registry = registry_with(scenario::parse_plugin_list(root, start, overrides));
  scenario::Scenario scenario = scenario::parse_scenario(root, start, *registry, overrides);
  return std::make_shared<LoadedScenario>(LoadedScenario{std::move(scenario), std::move(registry)});
}

std::vector<std::string> vehicle_names(const LoadedScenario& loaded) {
  std::vector<std::string> names;
  for (const auto& vehicle : loaded.scenario.vehicles) names.push_back(vehicle.name);
  return names;
}

/// A property that is a field of the scenario.
template <class T>
auto field(T scenario::Scenario::*member) {
  return [member](const LoadedScenario& loaded) { return loaded.scenario.*member; };
}

}  // namespace

scenario::Overrides overrides_from_python(const py::dict& values,
                                          const std::vector<std::string>& sets,
                                          std::optional<std::uint64_t> seed) {
  scenario::Overrides overrides{sets, seed};
  for (const auto& [key, value] : values) {
    if (!py::isinstance<py::str>(key)) {
      throw ConfigError(
          fmt::format("overrides has a key {}, must be a str", std::string(py::repr(key))));
    }
    const auto path = key.cast<std::string>();
    overrides.values.push_back({path, yaml_from_python(value, path)});
  }
  return overrides;
}

std::shared_ptr<Registry> registry_with(const std::vector<std::filesystem::path>& plugins) {
  auto registry = std::make_shared<Registry>();
  register_all(*registry);
  for (const auto& plugin : plugins) load_plugin(plugin, *registry);
  return registry;
}

void bind_scenario(py::module_& module) {
  using scenario::Scenario;
  py::class_<LoadedScenario, std::shared_ptr<LoadedScenario>>(
      module, "Scenario", "A checked scenario. vinerow.load() makes it; it does not change.")
      .def("_repr_html_", html_by("scenario_html"))
      .def_property_readonly("name", field(&Scenario::name))
      .def_property_readonly("description", field(&Scenario::description))
      .def_property_readonly("seed", field(&Scenario::seed))
      .def_property_readonly("duration_s", field(&Scenario::duration_s),
                             "The run ends here at the latest, s.")
      .def_property_readonly(
          "physics_step_s",
          [](const LoadedScenario& loaded) { return loaded.scenario.physics_step.nearest_s(); },
          "Time between two instants, s.")
      .def_property_readonly("yaml", field(&Scenario::resolved_yaml),
                             "The scenario with includes, overrides and defaults written out.")
      .def_property_readonly("warnings", field(&Scenario::warnings),
                             "Sentences about former names of keys.")
      .def_property_readonly("vehicles", &vehicle_names, "Names, in the scenario's order.");
  module.def("load_file", &load_file, py::arg("file"), py::arg("overrides"), py::arg("sets"),
             py::arg("seed"));
  module.def("load_tree", &load_tree, py::arg("tree"), py::arg("folder"), py::arg("overrides"),
             py::arg("sets"), py::arg("seed"));
}

}  // namespace vinerow::python
