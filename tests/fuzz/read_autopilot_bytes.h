#pragma once
/// What the fuzz target of autopilots does with its input.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vinerow::fuzz {

/// The first byte of an input, modulo their number; the rest is what is read.
enum class AutopilotInput : std::uint8_t {
  kServoPacket,  ///< one datagram of ArduPilot's JSON interface
  kMavlink,      ///< bytes of a firmware's MAVLink, read in pieces
  /// Messages: number of a known one, length of its payload, payload. They get headers and check
  /// bytes, so they reach what acts on them.
  kMessages,
  kParameters,  ///< a file of parameters
  kRecording    ///< a pcap file
};

struct AutopilotTally {
  int read = 0;         ///< packets, messages, parameters or datagrams
  int sent = 0;         ///< frames of the ground station in answer
  std::string refusal;  ///< of what was refused
};

struct AutopilotSeed {
  std::string name;
  std::string bytes;
  int read = 0;  ///< what a correct reader finds
};

/// Each below 2 kB.
std::vector<AutopilotSeed> autopilot_seeds();

/// Gives the input to its reader. Aborts if the code breaks its word: an exception that is no
/// ConfigError, a refusal that is no sentence, a frame of the ground station that cannot be read.
AutopilotTally read_autopilot_bytes(std::span<const std::uint8_t> bytes);

}  // namespace vinerow::fuzz
