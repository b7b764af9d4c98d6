#include "python/core/yaml_from_python.h"

#include <fmt/format.h>

#include "engine/core/error.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

constexpr int kMaxDepth = 64;  // of nested values; a list that contains itself ends here

io::YamlNode convert(const py::handle& value, const std::string& place, int depth) {
  if (depth > kMaxDepth) {
    throw ConfigError(fmt::format("{} is nested in more than {} levels", place, kMaxDepth));
  }
  io::YamlNode node;
  if (value.is_none()) {
    node.kind = io::YamlKind::kNull;
  } else if (py::isinstance<py::bool_>(value)) {
    node = io::yaml_boolean(value.cast<bool>());
  } else if (py::isinstance<py::int_>(value)) {
    try {
      node = io::yaml_integer(value.cast<std::int64_t>());
    } catch (const py::cast_error&) {
      throw ConfigError(
          fmt::format("{} = {}, must fit into 64 bits", place, std::string(py::str(value))));
    }
  } else if (py::isinstance<py::float_>(value)) {
    node = io::yaml_number(value.cast<double>());
  } else if (py::isinstance<py::str>(value)) {
    node = io::yaml_text(value.cast<std::string>());
  } else if (py::isinstance<py::dict>(value)) {
    node = io::yaml_mapping();
    for (const auto& [key, entry] : py::reinterpret_borrow<py::dict>(value)) {
      if (!py::isinstance<py::str>(key)) {
        throw ConfigError(
            fmt::format("{} has a key {}, must be a str", place, std::string(py::repr(key))));
      }
      const auto name = key.cast<std::string>();
      node.put(name, convert(entry, place.empty() ? name : place + "." + name, depth + 1));
    }
  } else if (py::hasattr(value, "__fspath__")) {
    node = io::yaml_text(py::str(value.attr("__fspath__")()));
  } else if (py::hasattr(value, "tolist")) {  // numpy's arrays and scalars
    node = convert(value.attr("tolist")(), place, depth + 1);
  } else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    node = io::yaml_list();
    int i = 0;
    for (const py::handle entry : py::reinterpret_borrow<py::sequence>(value)) {
      node.items.push_back(convert(entry, fmt::format("{}[{}]", place, i++), depth + 1));
    }
  } else {
    throw ConfigError(
        fmt::format("{} is of type {}, must be None, bool, int, float, str, a list or a dict",
                    place, std::string(py::str(py::type::handle_of(value).attr("__name__")))));
  }
  return node;
}

}  // namespace

io::YamlNode yaml_from_python(const py::handle& value, const std::string& place) {
  return convert(value, place, 0);
}

}  // namespace vinerow::python
