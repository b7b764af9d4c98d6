#pragma once
/// Built-in messages from Python values: for commands, and for what Python parts write.

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <string_view>

#include "engine/api/outside.h"

namespace vinerow::python {

/// What a message type can do without its C++ type.
struct MessageCodec {
  const char* name;  ///< kType
  OutsideSignal (*outside)(std::string signal);
  /// A command with the values of a mapping {field: value}; fields that are absent keep the
  /// default.
  /// @throws ConfigError "rover/plan: points[3].position must have 3 numbers, not 2"
  OutsideCommand (*command)(const std::string& signal, Time stamp, const pybind11::handle& value);
};

/// @returns nullptr if there is no such built-in type
const MessageCodec* find_codec(std::string_view type);

/// Type of a signal that a session can take over, from its name: "rover/actuators" is NamedValues.
/// @returns "" if the name does not determine it
std::string_view outside_type(std::string_view signal);

}  // namespace vinerow::python
