#include "engine/live/outbox.h"

#include <utility>

namespace vinerow::live {

void Outbox::add(FrameKind kind, Frame frame) {
  {
    const std::lock_guard lock(mutex_);
    const std::size_t limit = kind == FrameKind::kPicture ? kPictureBytes : kMessageBytes;
    if (kind != FrameKind::kAnswer && bytes_ >= limit) {
      ++dropped_;
      return;
    }
    bytes_ += frame.size();
    frames_.push_back(std::move(frame));
    if (std::exchange(is_sending_, true)) return;
  }
  wake_();
}

std::optional<Frame> Outbox::take() {
  const std::lock_guard lock(mutex_);
  if (frames_.empty()) {
    is_sending_ = false;
    return std::nullopt;
  }
  Frame frame = std::move(frames_.front());
  frames_.pop_front();
  bytes_ -= frame.size();
  return frame;
}

std::uint64_t Outbox::take_dropped() {
  return bytes_ < kMessageBytes / 2 ? dropped_.exchange(0) : 0;
}

}  // namespace vinerow::live
