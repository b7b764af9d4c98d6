#pragma once
/// Runs with files, their pages, and pictures of logs.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <filesystem>
#include <optional>
#include <vector>

namespace vinerow::render {
struct Image;
}

namespace vinerow::python {

/// Pictures of a log at some times, (h, w, 3) each. @param camera  a name, a dict of a camera's
/// keys, or None: the scenario's first camera, else one behind the first vehicle
/// @throws ConfigError, UsageError if this machine cannot draw
std::vector<pybind11::array_t<std::uint8_t>> render(const std::filesystem::path& log,
                                                    const std::vector<double>& times_s,
                                                    const pybind11::object& camera,
                                                    std::optional<int> width,
                                                    std::optional<int> height);

/// @throws ConfigError if a side of a picture is not one that `vinerow render` takes
void check_side(const char* name, std::optional<int> pixels);

/// A copy, (height, width, 3).
pybind11::array_t<std::uint8_t> pixels_of(const render::Image& image);

void bind_run(pybind11::module_& module);

}  // namespace vinerow::python
