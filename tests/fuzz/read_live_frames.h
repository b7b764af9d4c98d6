#pragma once
/// What the fuzz target of live runs does with its input.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace vinerow::fuzz {

/// Options of an input; its first byte.
enum LiveFlag : std::uint8_t {
  kInLockstep = 1,  ///< commands of velocities are due at stamps
  kNotBegun = 2,    ///< the run begins with the first kGoOn, after the clients were greeted
  kNotPaused = 4,   ///< services of a run that is paused refuse then
  kTwoClients = 8,  ///< frames alternate between two clients
};

/// Frames follow: kind, length as two bytes (little-endian), payload. A length beyond the end means
/// all the rest. Kinds are taken modulo their number.
enum class LiveFrame : std::uint8_t {
  kText,         ///< text frame of a client of Foxglove's protocol
  kBinary,       ///< binary frame of one
  kLongText,     ///< text frame: HEAD 0 UNIT 0 MIDDLE 0 UNIT 0 TAIL, both units many times
  kGoOn,         ///< the run goes on for some slices
  kClient,       ///< first byte: tick, greet, leave
  kCdrCommand,   ///< type of message, type of ROS, then CDR
  kJsonCommand,  ///< type of message, type of ROS, then JSON
  kCdrRequest,   ///< service, then CDR
  kRequest       ///< target, origin, subprotocols and token of an HTTP request
};

/// Whether the run takes commands of a type of message. The others are only decoded: each one more
/// makes the greeting of every client longer.
bool is_taken(std::string_view message_type);

/// What became of an input.
struct LiveTally {
  int frames = 0;
  int refusals = 0;     ///< warnings and errors that clients were sent, and refused direct commands
  int messages = 0;     ///< of channels, to clients
  int responses = 0;    ///< of services
  std::string refusal;  ///< the last one
};

/// Appends a frame to an input.
void add_frame(std::string& input, LiveFrame kind, std::string_view payload);

/// Gives the frames to clients of a live run, and to the readers of commands and requests.
/// Aborts if the code breaks its word: an exception that is no ConfigError, a frame to a client
/// that is no frame of the protocol, a service call without exactly one answer, a command whose
/// JSON and CDR differ. Not thread-safe.
LiveTally read_live_frames(std::span<const std::uint8_t> bytes);

}  // namespace vinerow::fuzz
