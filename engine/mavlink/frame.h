#pragma once
/// MAVLink frames: version 2 is written, versions 1 and 2 are read. Frames are not signed;
/// signatures of a peer are skipped. Source: MAVLink's guide, "Packet serialization".

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "engine/mavlink/message.h"

namespace vinerow::mavlink {

/// Header, payload, CRC and signature.
inline constexpr std::size_t kMaxFrame = 10 + kMaxPayload + 2 + 13;

/// Identity of a sender.
struct Sender {
  std::uint8_t system = 1;
  std::uint8_t component = 1;  ///< 1: autopilot
  friend bool operator==(const Sender&, const Sender&) = default;
};

/// A frame whose CRC is correct.
struct Frame {
  std::uint32_t id = 0;
  Sender sender;
  std::uint8_t sequence = 0;
  std::span<const std::uint8_t> payload;  ///< valid until the next bytes are read
};

/// @returns the message; nullopt if the frame holds another one
template <class M>
std::optional<M> read(const Frame& frame) {
  if (frame.id != M::kId) return std::nullopt;
  std::optional<M> message(std::in_place);
  read_payload(frame.payload, *message);
  return message;
}

/// Makes the frames of one sender, numbered in sequence.
class FrameWriter {
 public:
  explicit FrameWriter(Sender sender) : sender_(sender) {}

  /// @returns the bytes of a frame, valid until the next call
  template <class M>
  std::span<const std::uint8_t> write(const M& message) {
    static_assert(payload_size<M>() <= kMaxPayload);
    static constexpr std::uint8_t kCrcExtra = crc_extra<M>();
    const std::size_t size = write_payload(message, std::span(frame_).subspan(kHeader));
    return finish(M::kId, size, kCrcExtra);
  }

 private:
  static constexpr std::size_t kHeader = 10;
  std::span<const std::uint8_t> finish(std::uint32_t id, std::size_t payload,
                                       std::uint8_t crc_extra);

  Sender sender_;
  std::uint8_t sequence_ = 0;
  std::array<std::uint8_t, kMaxFrame> frame_{};
};

/// Finds frames in the bytes of one peer, however they are cut.
class FrameReader {
 public:
  /// Counts of what was not a frame that we know.
  struct Losses {
    std::uint64_t wrong_crc = 0;  ///< damaged, or of another definition
    std::uint64_t unknown = 0;    ///< messages that messages.h does not declare
    std::uint64_t bytes = 0;      ///< outside of frames
  };

  /// @param take  called for each frame
  void read(std::span<const std::uint8_t> bytes, const std::function<void(const Frame&)>& take);
  const Losses& losses() const { return losses_; }

 private:
  /// Takes what lies at the start of the buffer. @returns bytes consumed; 0: more are needed
  std::size_t take_next(const std::function<void(const Frame&)>& take);

  std::array<std::uint8_t, kMaxFrame> buffer_{};
  std::size_t size_ = 0;
  Losses losses_;
};

}  // namespace vinerow::mavlink
