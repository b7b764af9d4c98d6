#pragma once
/// vinerow.Scenario: a loaded scenario and the parts that it needs.

#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/scenario/scenario.h"

namespace vinerow::python {

/// Immutable.
struct LoadedScenario {
  scenario::Scenario scenario;
  std::shared_ptr<const Registry> registry;
};

/// Overrides of a dict of key paths, of texts and of a seed. @throws ConfigError
scenario::Overrides overrides_from_python(const pybind11::dict& values,
                                          const std::vector<std::string>& sets,
                                          std::optional<std::uint64_t> seed);

/// The built-in parts and those of plug-ins. @throws ConfigError
std::shared_ptr<Registry> registry_with(const std::vector<std::filesystem::path>& plugins);

void bind_scenario(pybind11::module_& module);

}  // namespace vinerow::python
