#pragma once
/// Frames that wait to be sent to one client. A slow or dead client fills it; then messages are
/// dropped, pictures first, and counted. Memory stays bounded, and nobody waits.

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace vinerow::live {

/// One WebSocket message.
struct Frame {
  bool is_binary = false;
  std::string head;  ///< the whole text, or the first bytes of a binary frame
  std::shared_ptr<const std::vector<std::uint8_t>> body = nullptr;  ///< the rest; may be null

  std::size_t size() const { return head.size() + (body ? body->size() : 0); }
};

enum class FrameKind {
  kAnswer,   ///< of the protocol: never dropped
  kMessage,  ///< dropped when kMessageBytes wait
  kPicture   ///< dropped when kPictureBytes wait
};

class Outbox {
 public:
  static constexpr std::size_t kPictureBytes = 2 << 20;
  static constexpr std::size_t kMessageBytes = 8 << 20;
  /// A client that lets so much wait is disconnected: it asks without reading the answers.
  static constexpr std::size_t kMostBytes = 64 << 20;

  /// @param wake  called when a frame waits and the sender is idle, from any thread
  explicit Outbox(std::function<void()> wake) : wake_(std::move(wake)) {}

  /// From any thread. A single frame larger than the limit passes if nothing waits.
  void add(FrameKind kind, Frame frame);
  /// False if a message would be dropped now.
  bool has_room() const { return bytes_.load(std::memory_order_relaxed) < kMessageBytes; }
  /// A message was dropped before it became a frame.
  void miss() { ++dropped_; }

  /// The next frame, for the sender; without one, the sender is idle until wake().
  std::optional<Frame> take();
  /// Number of dropped messages, once there is room again.
  std::uint64_t take_dropped();
  /// More than kMostBytes wait.
  bool is_flooded() const { return bytes_.load(std::memory_order_relaxed) > kMostBytes; }

 private:
  const std::function<void()> wake_;
  std::mutex mutex_;
  std::deque<Frame> frames_;
  std::atomic<std::size_t> bytes_ = 0;
  std::atomic<std::uint64_t> dropped_ = 0;
  bool is_sending_ = false;
};

}  // namespace vinerow::live
