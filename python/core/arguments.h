#pragma once
/// Arguments and results of Python functions that have a type in signatures, from which the stubs
/// (python/vinerow/_core.pyi) are made.

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "engine/core/error.h"

namespace vinerow::python {

/// Name of a Python object's type, "str".
inline std::string type_name_of(const pybind11::handle& value) {
  return pybind11::str(pybind11::type::handle_of(value).attr("__name__"));
}

/// Arguments that take any value, so that a wrong type is one sentence with the argument's name;
/// pybind11's own text lists the overloads.
struct NumberArgument {
  pybind11::object given;
  /// @throws ConfigError "until_s must be a number, not str"
  double value(const char* name) const {
    const double number = PyFloat_AsDouble(given.ptr());
    if (!PyErr_Occurred()) return number;
    PyErr_Clear();
    throw ConfigError(fmt::format("{} must be a number, not {}", name, type_name_of(given)));
  }
};

struct SeedArgument {
  pybind11::object given;
  /// @throws ConfigError
  std::uint64_t value() const {
    const auto whole = pybind11::reinterpret_steal<pybind11::object>(PyNumber_Index(given.ptr()));
    const std::uint64_t seed = whole ? PyLong_AsUnsignedLongLong(whole.ptr()) : 0;
    if (!PyErr_Occurred()) return seed;
    PyErr_Clear();
    throw ConfigError(fmt::format("seed = {}, must be a whole number from 0 to {}",
                                  std::string(pybind11::repr(given)), UINT64_MAX));
  }
};

struct TextArgument {
  pybind11::object given;
  /// @throws ConfigError "vehicle must be a str, not int"
  std::string value(const char* name) const {
    if (pybind11::isinstance<pybind11::str>(given)) return given.cast<std::string>();
    throw ConfigError(fmt::format("{} must be a str, not {}", name, type_name_of(given)));
  }
};

struct PathArgument {
  pybind11::object given;
  /// @throws ConfigError "file must be a path, not int"
  std::filesystem::path value(const char* name) const {
    const auto text = pybind11::reinterpret_steal<pybind11::object>(PyOS_FSPath(given.ptr()));
    if (text && pybind11::isinstance<pybind11::str>(text)) return text.cast<std::string>();
    PyErr_Clear();
    throw ConfigError(fmt::format("{} must be a path, not {}", name, type_name_of(given)));
  }
};

/// HTML of an object for notebooks, by a function of vinerow.display.
inline auto html_by(const char* function) {
  return [function](const pybind11::object& self) {
    return pybind11::module_::import("vinerow.display").attr(function)(self).cast<std::string>();
  };
}

/// A text as a template's argument.
template <std::size_t kSize>
struct TypeText {
  char text[kSize] = {};
  consteval TypeText(const char (&from)[kSize]) {  // NOLINT: implicit on purpose
    for (std::size_t i = 0; i < kSize; ++i) text[i] = from[i];
  }
};

/// Argument or result of a function: an object whose type is the text in signatures. Arguments are
/// not checked.
template <TypeText kType>
class Typed : public pybind11::object {
 public:
  Typed() = default;
  Typed(pybind11::object value)  // NOLINT: implicit on purpose
      : pybind11::object(std::move(value)) {}
  // What pybind11's casts use.
  Typed(pybind11::handle value, borrowed_t) : pybind11::object(value, borrowed_t{}) {}
  Typed(pybind11::handle value, stolen_t) : pybind11::object(value, stolen_t{}) {}
  static bool check_(pybind11::handle value) { return value.ptr() != nullptr; }
};

template <class T>
struct AnyArgumentCaster {
  bool load(pybind11::handle given, bool) {
    value.given = pybind11::reinterpret_borrow<pybind11::object>(given);
    return true;
  }
  static pybind11::handle cast(const T& argument, pybind11::return_value_policy, pybind11::handle) {
    return argument.given.inc_ref();
  }
  template <class U>
  using cast_op_type = pybind11::detail::movable_cast_op_type<U>;
  explicit operator T*() { return &value; }
  explicit operator T&() { return value; }
  explicit operator T&&() && { return std::move(value); }
  T value;
};

}  // namespace vinerow::python

namespace pybind11::detail {

template <>
struct type_caster<vinerow::python::NumberArgument>
    : vinerow::python::AnyArgumentCaster<vinerow::python::NumberArgument> {
  static constexpr auto name = const_name("float");
};
template <>
struct type_caster<vinerow::python::SeedArgument>
    : vinerow::python::AnyArgumentCaster<vinerow::python::SeedArgument> {
  static constexpr auto name = const_name("int");
};
template <>
struct type_caster<vinerow::python::TextArgument>
    : vinerow::python::AnyArgumentCaster<vinerow::python::TextArgument> {
  static constexpr auto name = const_name("str");
};
template <>
struct type_caster<vinerow::python::PathArgument>
    : vinerow::python::AnyArgumentCaster<vinerow::python::PathArgument> {
  static constexpr auto name = const_name("typing.Union[str, os.PathLike[str]]");
};
template <vinerow::python::TypeText kType>
struct handle_type_name<vinerow::python::Typed<kType>> {
  static constexpr auto name = const_name(kType.text);
};

}  // namespace pybind11::detail
