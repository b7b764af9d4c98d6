#pragma once
/// Parsed .msg definitions from a log. Any message can be decoded with them, even of types unknown
/// to this program.
///
/// Source: https://docs.ros.org/en/humble/Concepts/Basic/About-Interfaces.html (.msg files), and
/// https://mcap.dev/spec/registry#ros2msg (nested messages follow, each after a line of "=" and a
/// line "MSG: package/Type").

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vinerow::record {

enum class RosKind {
  kBool,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
  kText,
  kMessage,
};

/// Size of one number in a message, in bytes; 0 for text and messages.
std::size_t size_of(RosKind kind);

struct RosField {
  enum class Shape { kOne, kArray, kSequence };

  std::string name;
  RosKind kind = RosKind::kFloat64;
  Shape shape = Shape::kOne;
  std::size_t length = 0;   ///< of an array
  std::size_t message = 0;  ///< for kMessage: index in RosSchema::messages
};

struct RosMessageType {
  std::string name;  ///< "geometry_msgs/Pose"
  std::vector<RosField> fields;
};

struct RosSchema {
  std::vector<RosMessageType> messages;  ///< the first one is the top-level message

  /// Parses a definition. Constants, default values, comments and limits of sequences are skipped.
  /// @param name  "nav_msgs/msg/Odometry"  @param text  encoding "ros2msg"
  /// @throws ConfigError "the definition of a/B names the type 'c/D', which it does not hold" |
  /// "...
  ///   line 'float64', must be a type and a name" | "... which holds itself" | "... is deeper than
  ///   64 messages"
  static RosSchema parse(std::string_view name, std::string_view text);
};

}  // namespace vinerow::record
