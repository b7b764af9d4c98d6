#pragma once
/// What every fuzz target of point clouds does with its input.

#include <cstdint>
#include <span>
#include <string>

namespace vinerow::fuzz {

enum class CloudKind { kAny, kLas, kPly, kPcd, kXyz };

/// Opens the bytes as a file "input.<extension>" with the reader of that kind (kAny: as
/// open_point_cloud() decides) and reads all points of it.
/// @returns the sentence that refuses them, or "" where they were read. Aborts where a reader
/// breaks its word: a point that is not finite, a tally that does not add up, a refusal that does
/// not name the file or has unprintable bytes, an exception that is no ConfigError
std::string read_cloud_bytes(CloudKind kind, std::span<const std::uint8_t> bytes);

}  // namespace vinerow::fuzz
