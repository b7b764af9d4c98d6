#pragma once
/// Runs with files, their pages, and pictures of logs.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <filesystem>
#include <optional>
#include <vector>

namespace vinerow::python {

/// Pictures of a log at some times, (h, w, 3) each. @param camera  a name, a dict of a camera's
/// keys, or None: the scenario's first camera, else one behind the first vehicle
/// @throws ConfigError, UsageError if this machine cannot draw
std::vector<pybind11::array_t<std::uint8_t>> render(const std::filesystem::path& log,
                                                    const std::vector<double>& times_s,
                                                    const pybind11::object& camera,
                                                    std::optional<int> width,
                                                    std::optional<int> height);

void bind_run(pybind11::module_& module);

}  // namespace vinerow::python
