#pragma once
/// Built-in messages from Python values: for commands, and for what Python parts write.

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/api/messages/path.h"
#include "engine/api/outside.h"

namespace vinerow::python {

/// SignalReader of any type.
class AnyReader {
 public:
  virtual ~AnyReader() = default;
  virtual std::uint64_t count() const = 0;
  /// The following @pre count() > 0
  virtual Time stamp() const = 0;
  virtual void describe(FieldVisitor& visitor) const = 0;
};

/// SignalWriter of any type.
class AnyWriter {
 public:
  virtual ~AnyWriter() = default;
  /// @param value  as of MessageCodec::command. @returns names that the message contains, of
  /// NamedValues
  /// @throws ConfigError
  virtual std::vector<std::string> write(Time stamp, const pybind11::handle& value) = 0;
};

/// What a message type can do without its C++ type.
struct MessageCodec {
  const char* name;  ///< kType
  OutsideSignal (*outside)(std::string signal);
  /// A command with the values of a mapping {field: value}; fields that are absent keep the
  /// default.
  /// @throws ConfigError "rover/plan: points[3].position must have 3 numbers, not 2"
  OutsideCommand (*command)(const std::string& signal, Time stamp, const pybind11::handle& value);
  std::unique_ptr<AnyReader> (*read)(Ports& ports, const std::string& name, bool optional);
  std::unique_ptr<AnyWriter> (*write)(Ports& ports, const std::string& name);
};

/// A path from a dict of its fields. @throws ConfigError
PlannedPath path_from_python(const pybind11::handle& value, const std::string& place);

/// Names of the built-in types.
std::vector<std::string> message_types();

/// @returns nullptr if there is no such built-in type
const MessageCodec* find_codec(std::string_view type);

/// Type of a signal that a session can take over, from its name: "rover/actuators" is NamedValues.
/// @returns "" if the name does not determine it
std::string_view outside_type(std::string_view signal);

}  // namespace vinerow::python
