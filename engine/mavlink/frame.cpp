#include "engine/mavlink/frame.h"

#include <algorithm>

#include "engine/mavlink/dialect.h"

namespace vinerow::mavlink {
namespace {

constexpr std::uint8_t kStart1 = 0xFE, kStart2 = 0xFD;
constexpr std::size_t kHeader1 = 6, kHeader2 = 10, kCrc = 2, kSignature = 13;
constexpr std::uint8_t kIsSigned = 1;  // the only incompatible flag that exists

std::uint16_t frame_crc(std::span<const std::uint8_t> after_start, std::uint8_t crc_extra) {
  Crc16 crc;
  crc.add(after_start);
  crc.add(crc_extra);
  return crc.value();
}

}  // namespace

std::span<const std::uint8_t> FrameWriter::finish(std::uint32_t id, std::size_t payload,
                                                  std::uint8_t crc_extra) {
  frame_[0] = kStart2;
  frame_[1] = static_cast<std::uint8_t>(payload);
  frame_[2] = frame_[3] = 0;  // flags
  frame_[4] = sequence_++;
  frame_[5] = sender_.system;
  frame_[6] = sender_.component;
  for (int i = 0; i < 3; ++i) frame_[7 + i] = static_cast<std::uint8_t>(id >> (8 * i));
  const std::size_t end = kHeader2 + payload;
  const std::uint16_t crc = frame_crc(std::span(frame_).subspan(1, end - 1), crc_extra);
  frame_[end] = static_cast<std::uint8_t>(crc & 0xFF);
  frame_[end + 1] = static_cast<std::uint8_t>(crc >> 8);
  return std::span(frame_).first(end + kCrc);
}

void FrameReader::read(std::span<const std::uint8_t> bytes,
                       const std::function<void(const Frame&)>& take) {
  while (!bytes.empty()) {
    const std::size_t added = std::min(bytes.size(), buffer_.size() - size_);
    std::copy_n(bytes.begin(), added, buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += added;
    bytes = bytes.subspan(added);
    std::size_t begin = 0;
    while (begin < size_) {
      // A frame starts at the front of the buffer, so that the longest one fits.
      std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin),
                buffer_.begin() + static_cast<std::ptrdiff_t>(size_), buffer_.begin());
      size_ -= begin;
      begin = take_next(take);
      if (begin == 0) break;
    }
    if (begin == size_) size_ = 0;
  }
}

std::size_t FrameReader::take_next(const std::function<void(const Frame&)>& take) {
  const bool is_version_2 = buffer_[0] == kStart2;
  if (!is_version_2 && buffer_[0] != kStart1) {
    ++losses_.bytes;
    return 1;
  }
  const std::size_t header = is_version_2 ? kHeader2 : kHeader1;
  if (size_ < header) return 0;
  const std::uint8_t flags = is_version_2 ? buffer_[2] : 0;
  const std::size_t payload = buffer_[1];
  const std::size_t end = header + payload + kCrc + ((flags & kIsSigned) != 0 ? kSignature : 0);
  if (size_ < end) return 0;

  Frame frame;
  if (is_version_2) {
    frame.sequence = buffer_[4];
    frame.sender = {buffer_[5], buffer_[6]};
    frame.id = buffer_[7] | buffer_[8] << 8 | static_cast<std::uint32_t>(buffer_[9]) << 16;
  } else {
    frame.sequence = buffer_[2];
    frame.sender = {buffer_[3], buffer_[4]};
    frame.id = buffer_[5];
  }
  // Frames of unknown messages cannot be checked. They are skipped whole, as MAVLink's routers do.
  const MessageLayout* layout = find_message(frame.id);
  if (layout == nullptr) {
    ++losses_.unknown;
    return end;
  }
  const std::uint16_t crc =
      frame_crc(std::span(buffer_).subspan(1, header + payload - 1), layout->crc_extra);
  const std::uint16_t sent =
      static_cast<std::uint16_t>(buffer_[header + payload] | buffer_[header + payload + 1] << 8);
  if (crc != sent || (flags & ~kIsSigned) != 0) {
    ++losses_.wrong_crc;
    return 1;  // the start may have been a byte of another frame
  }
  frame.payload = std::span(buffer_).subspan(header, payload);
  take(frame);
  return end;
}

}  // namespace vinerow::mavlink
