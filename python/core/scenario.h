#pragma once
/// vinerow.Scenario: a loaded scenario and the parts that it needs.

#include <pybind11/pybind11.h>

#include <memory>

#include "engine/api/registry.h"
#include "engine/scenario/scenario.h"

namespace vinerow::python {

/// Immutable.
struct LoadedScenario {
  scenario::Scenario scenario;
  std::shared_ptr<const Registry> registry;
};

void bind_scenario(pybind11::module_& module);

}  // namespace vinerow::python
