#pragma once
/// Receiver of encoded messages: a log file, or the clients of a live run.

#include <cstdint>
#include <string>

#include "engine/record/byte_buffer.h"
#include "engine/record/mcap_format.h"

namespace vinerow::record {

/// A channel of CDR-encoded ROS 2 messages.
struct ChannelSpec {
  std::string topic;       ///< "/rover/gps"
  std::string type;        ///< "sensor_msgs/msg/NavSatFix"
  std::string definition;  ///< text in the encoding "ros2msg"
  TextMap metadata;        ///< as in ChannelInfo (log_reader.h)
};

class MessageSink {
 public:
  virtual ~MessageSink() = default;
  /// @returns id >= 1
  virtual std::uint16_t add_channel(const ChannelSpec& channel) = 0;
  /// False if nobody would receive a message of this channel now: it is then not encoded.
  virtual bool wants(std::uint16_t /*channel*/) const { return true; }
  /// Starts a message; add its bytes to the returned buffer, then call end_message().
  virtual ByteBuffer& start_message(std::uint16_t channel, std::uint64_t log_time,
                                    std::uint64_t publish_time) = 0;
  virtual void end_message() = 0;
};

}  // namespace vinerow::record
