#pragma once
/// Records of MCAP files, version 0 (specification: mcap.dev/spec).
///
///     magic | Header | Metadata, Schemas, Channels, { Chunk, MessageIndex... }, Attachments,
///     DataEnd
///           | summary: Schemas, Channels, Statistics, ChunkIndexes, Attachment- and
///           MetadataIndexes | SummaryOffsets | Footer | magic
///
/// A record is an opcode (1 byte), the length of its content (8 bytes) and the content. Numbers are
/// little-endian; texts, maps and lists start with their length in bytes (4 bytes).

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "engine/record/byte_buffer.h"

namespace vinerow::record {

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr std::size_t kRecordHeadSize = 1 + 8;
constexpr std::size_t kFooterContentSize = 8 + 8 + 4;
/// Footer and closing magic.
constexpr std::size_t kTailSize = kRecordHeadSize + kFooterContentSize + kMagic.size();
/// Channel, sequence, log time, publish time; the message's own bytes follow.
constexpr std::size_t kMessageHeadSize = 2 + 4 + 8 + 8;

using TextMap = std::map<std::string, std::string>;

// Writing ----------------------------------------------------------------------------------------

inline void add_text(ByteBuffer& out, std::string_view text) {
  out.add(static_cast<std::uint32_t>(text.size()));
  out.add_bytes(text.data(), text.size());
}

inline void add_map(ByteBuffer& out, const TextMap& map) {
  std::size_t size = 0;
  for (const auto& [key, value] : map) size += 8 + key.size() + value.size();
  out.add(static_cast<std::uint32_t>(size));
  for (const auto& [key, value] : map) {
    add_text(out, key);
    add_text(out, value);
  }
}

/// Scope of a record being written: the constructor starts the record, the destructor fills in its
/// length.
class RecordScope {
 public:
  RecordScope(ByteBuffer& out, Opcode opcode) : out_(out) {
    out_.add(opcode);
    length_at_ = out_.size();
    out_.add(std::uint64_t{0});
  }
  ~RecordScope() { out_.put(length_at_, static_cast<std::uint64_t>(out_.size() - length_at_ - 8)); }
  RecordScope(const RecordScope&) = delete;
  RecordScope& operator=(const RecordScope&) = delete;

 private:
  ByteBuffer& out_;
  std::size_t length_at_ = 0;
};

// Reading ----------------------------------------------------------------------------------------

/// Reader of the fields in a record's content. Past the end it returns zeros and ok() is false.
class FieldReader {
 public:
  explicit FieldReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  bool at_end() const { return at_ >= bytes_.size(); }
  std::size_t position() const { return at_; }

  template <class T>
  T read() {
    T value{};
    const std::span<const std::uint8_t> raw = read_bytes(sizeof value);
    if (ok_) std::memcpy(&value, raw.data(), sizeof value);
    return value;
  }
  std::span<const std::uint8_t> read_bytes(std::uint64_t count) {
    if (!ok_ || bytes_.size() - at_ < count) {
      ok_ = false;
      return {};
    }
    const std::span<const std::uint8_t> part = bytes_.subspan(at_, count);
    at_ += count;
    return part;
  }
  std::string read_text() {
    const std::span<const std::uint8_t> raw = read_bytes(read<std::uint32_t>());
    return std::string(reinterpret_cast<const char*>(raw.data()), raw.size());
  }
  TextMap read_map() {
    FieldReader inner(read_bytes(read<std::uint32_t>()));
    TextMap map;
    while (ok_ && inner.ok() && !inner.at_end()) {
      std::string key = inner.read_text();
      map[std::move(key)] = inner.read_text();
    }
    ok_ = ok_ && inner.ok();
    return map;
  }
  std::span<const std::uint8_t> rest() { return read_bytes(bytes_.size() - at_); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

/// View of one record in memory.
struct RecordView {
  Opcode opcode{};
  std::span<const std::uint8_t> content;
};

/// Reads the next record. @returns false at the end, or if the rest is not a complete record
inline bool read_record(FieldReader& from, RecordView& record) {
  if (from.at_end()) return false;
  record.opcode = static_cast<Opcode>(from.read<std::uint8_t>());
  record.content = from.read_bytes(from.read<std::uint64_t>());
  return from.ok();
}

}  // namespace vinerow::record
