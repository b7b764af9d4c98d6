#pragma once
/// ROS 2 messages as JSON, by their .msg definition: for clients without a CDR encoder.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/record/ros_schema.h"

namespace vinerow::live {

/// Parses a text of a peer. @returns a discarded value if it is no JSON
/// @throws ConfigError if it is nested deeper than 64 levels
nlohmann::json parse_json(std::string_view text);

/// Encodes a JSON object as a CDR message. Absent fields are zero; of `stamp` fields, rosbridge's
/// spelling {"secs", "nsecs"} is also read.
/// @throws ConfigError on a field that the type does not have, or a value of another kind or range
std::vector<std::uint8_t> cdr_from_json(const nlohmann::json& value,
                                        const record::RosSchema& schema);

/// Decodes a CDR message (little-endian). Numbers that are not finite become null.
/// @throws ConfigError if the bytes do not hold such a message
nlohmann::json json_from_cdr(std::span<const std::uint8_t> message,
                             const record::RosSchema& schema);

}  // namespace vinerow::live
