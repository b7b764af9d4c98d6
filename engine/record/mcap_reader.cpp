#include "engine/record/mcap_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "engine/core/error.h"
#include "engine/record/compression.h"
#include "engine/record/crc32.h"

namespace vinerow::record {
namespace {

bool parse_message(std::span<const std::uint8_t> content, McapMessage& message) {
  FieldReader in(content);
  message.channel = in.read<std::uint16_t>();
  message.sequence = in.read<std::uint32_t>();
  message.log_time = in.read<std::uint64_t>();
  message.publish_time = in.read<std::uint64_t>();
  message.data = in.rest();
  return in.ok();
}

}  // namespace

McapReader::McapReader(const std::filesystem::path& file) : name_(file.string()) {
  errno = 0;
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw ConfigError(name_ + ": cannot be read: it is a folder");
  }
  file_.open(file, std::ios::binary);
  if (!file_) throw ConfigError(name_ + ": cannot be read: " + std::strerror(errno));
  file_.seekg(0, std::ios::end);
  file_size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(0, file_.tellg()));

  if (!read_at(0, kMagic.size(), record_) ||
      std::memcmp(record_.data(), kMagic.data(), kMagic.size()) != 0) {
    throw ConfigError(name_ + ": not an MCAP file");
  }
  Head head;
  if (!read_head(kMagic.size(), head) || head.opcode != Opcode::kHeader ||
      !read_at(kMagic.size() + kRecordHeadSize, head.length, record_)) {
    throw ConfigError(name_ + ": an MCAP file that is cut off or damaged inside its first record");
  }
  FieldReader header(record_.view());
  profile_ = header.read_text();
  library_ = header.read_text();
  first_record_ = kMagic.size() + kRecordHeadSize + head.length;

  complete_ = load_summary();
  if (!complete_) {
    forget_summary();
    scan();
  }
}

bool McapReader::read_at(std::uint64_t offset, std::uint64_t size, ByteBuffer& out) {
  out.clear();
  if (offset > file_size_ || size > file_size_ - offset) return false;
  out.resize(size);
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(offset));
  file_.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(size));
  return static_cast<std::uint64_t>(file_.gcount()) == size;
}

bool McapReader::read_head(std::uint64_t offset, Head& head) {
  if (!read_at(offset, kRecordHeadSize, record_)) return false;
  FieldReader in(record_.view());
  head.opcode = static_cast<Opcode>(in.read<std::uint8_t>());
  head.length = in.read<std::uint64_t>();
  return head.length <= file_size_ - offset - kRecordHeadSize;
}

bool McapReader::load_summary() {
  if (file_size_ < first_record_ + kTailSize) return false;
  const std::uint64_t footer_at = file_size_ - kTailSize;
  if (!read_at(footer_at, kTailSize, record_)) return false;
  FieldReader tail(record_.view());
  RecordView footer;
  if (!read_record(tail, footer) || footer.opcode != Opcode::kFooter ||
      footer.content.size() != kFooterContentSize ||
      !std::ranges::equal(tail.rest(), std::span(kMagic))) {
    return false;
  }
  FieldReader fields(footer.content);
  const auto summary_start = fields.read<std::uint64_t>();
  fields.read<std::uint64_t>();
  const auto crc = fields.read<std::uint32_t>();
  if (summary_start == 0) return false;
  if (summary_start < first_record_ || summary_start > footer_at) return false;

  ByteBuffer summary;
  const std::uint64_t summary_size = footer_at - summary_start;
  const std::uint64_t covered = summary_size + kRecordHeadSize + 16;
  if (!read_at(summary_start, covered, summary)) return false;
  if (crc != 0 && calc_crc32(summary.view()) != crc) {
    warnings_.push_back(name_ + ": the summary is damaged; the file was scanned instead");
    return false;
  }
  return parse_summary(summary.view().first(summary_size));
}

bool McapReader::parse_summary(std::span<const std::uint8_t> records) {
  FieldReader in(records);
  RecordView record;
  bool has_statistics = false;
  std::vector<std::uint64_t> attachments, metadata;
  while (read_record(in, record)) {
    FieldReader fields(record.content);
    switch (record.opcode) {
      case Opcode::kSchema:
        if (!parse_schema(record.content)) return false;
        break;
      case Opcode::kChannel:
        if (!parse_channel(record.content)) return false;
        break;
      case Opcode::kStatistics: {
        has_statistics = true;
        message_count_ = fields.read<std::uint64_t>();
        fields.read_bytes(2 + 4 + 4 + 4 + 4);
        start_time_ = fields.read<std::uint64_t>();
        end_time_ = fields.read<std::uint64_t>();
        FieldReader counts(fields.read_bytes(fields.read<std::uint32_t>()));
        while (fields.ok() && counts.ok() && !counts.at_end()) {
          const auto id = counts.read<std::uint16_t>();
          const auto count = counts.read<std::uint64_t>();
          const auto channel = channels_.find(id);
          if (channel != channels_.end()) channel->second.messages = count;
        }
        if (!fields.ok() || !counts.ok()) return false;
        break;
      }
      case Opcode::kChunkIndex: {
        Piece& piece = pieces_.emplace_back();
        fields.read_bytes(8 + 8);
        piece.offset = fields.read<std::uint64_t>();
        piece.length = fields.read<std::uint64_t>();
        FieldReader offsets(fields.read_bytes(fields.read<std::uint32_t>()));
        while (fields.ok() && offsets.ok() && !offsets.at_end()) {
          piece.channels.insert(offsets.read<std::uint16_t>());
          offsets.read<std::uint64_t>();
        }
        if (!fields.ok() || !offsets.ok()) return false;
        // Some writers omit the message indexes: the chunk may then contain any channel.
        if (piece.channels.empty()) {
          for (const auto& [id, channel] : channels_) piece.channels.insert(id);
        }
        break;
      }
      case Opcode::kAttachmentIndex:
        attachments.push_back(fields.read<std::uint64_t>());
        break;
      case Opcode::kMetadataIndex:
        metadata.push_back(fields.read<std::uint64_t>());
        break;
      default:
        break;
    }
    if (!fields.ok()) return false;
  }
  if (!in.ok() || !has_statistics) return false;
  // Messages outside chunks are not in an index.
  if (message_count_ > 0 && pieces_.empty()) return false;
  std::ranges::sort(pieces_, {}, &Piece::offset);
  return load_indexed_records(attachments, Opcode::kAttachment) &&
         load_indexed_records(metadata, Opcode::kMetadata);
}

bool McapReader::load_indexed_records(const std::vector<std::uint64_t>& offsets, Opcode opcode) {
  for (const std::uint64_t offset : offsets) {
    Head head;
    if (offset > file_size_ || !read_head(offset, head) || head.opcode != opcode) return false;
    if (!read_at(offset + kRecordHeadSize, head.length, record_)) return false;
    if (opcode == Opcode::kMetadata && !parse_metadata(record_.view())) return false;
    if (opcode == Opcode::kAttachment && !parse_attachment(record_.view(), offset)) return false;
  }
  return true;
}

void McapReader::forget_summary() {
  message_count_ = start_time_ = end_time_ = 0;
  schemas_.clear();
  channels_.clear();
  metadata_.clear();
  attachments_.clear();
  pieces_.clear();
}

void McapReader::scan() {
  ByteBuffer chunk;
  std::uint64_t at = first_record_;
  Head head;
  while (read_head(at, head)) {
    const std::uint64_t next = at + kRecordHeadSize + head.length;
    // The summary after DataEnd repeats earlier records.
    if (head.opcode == Opcode::kDataEnd || head.opcode == Opcode::kFooter) break;
    const bool is_wanted = head.opcode == Opcode::kSchema || head.opcode == Opcode::kChannel ||
                           head.opcode == Opcode::kMessage || head.opcode == Opcode::kMetadata ||
                           head.opcode == Opcode::kAttachment;
    if (is_wanted && !read_at(at + kRecordHeadSize, head.length, record_)) break;
    bool good = true;
    if (head.opcode == Opcode::kSchema) good = parse_schema(record_.view());
    if (head.opcode == Opcode::kChannel) good = parse_channel(record_.view());
    if (head.opcode == Opcode::kMetadata) good = parse_metadata(record_.view());
    if (head.opcode == Opcode::kAttachment) good = parse_attachment(record_.view(), at);
    if (head.opcode == Opcode::kMessage) {
      McapMessage message;
      good = parse_message(record_.view(), message);
      if (good) {
        const bool follows = !pieces_.empty() && !pieces_.back().is_chunk &&
                             pieces_.back().offset + pieces_.back().length == at;
        if (!follows)
          pieces_.push_back({.offset = at, .length = 0, .is_chunk = false, .channels = {}});
        pieces_.back().length += next - at;
        pieces_.back().channels.insert(message.channel);
        scan_message(message);
      }
    }
    if (head.opcode == Opcode::kChunk) {
      Piece piece{.offset = at, .length = next - at, .is_chunk = true, .channels = {}};
      if (load_chunk(piece, chunk)) {
        FieldReader records(chunk.view());
        RecordView record;
        while (read_record(records, record)) {
          McapMessage message;
          if (record.opcode == Opcode::kSchema) parse_schema(record.content);
          if (record.opcode == Opcode::kChannel) parse_channel(record.content);
          if (record.opcode == Opcode::kMessage && parse_message(record.content, message)) {
            piece.channels.insert(message.channel);
            scan_message(message);
          }
        }
        pieces_.push_back(std::move(piece));
      }
    }
    if (!good) warn_damaged(at, fmt::format("record {:#04x}", static_cast<int>(head.opcode)));
    at = next;
  }
}

void McapReader::scan_message(const McapMessage& message) {
  const auto channel = channels_.find(message.channel);
  if (channel == channels_.end()) return;
  ++channel->second.messages;
  start_time_ = message_count_ == 0 ? message.log_time : std::min(start_time_, message.log_time);
  end_time_ = message_count_ == 0 ? message.log_time : std::max(end_time_, message.log_time);
  ++message_count_;
}

bool McapReader::parse_schema(std::span<const std::uint8_t> content) {
  FieldReader in(content);
  const auto id = in.read<std::uint16_t>();
  McapSchema schema;
  schema.name = in.read_text();
  schema.encoding = in.read_text();
  schema.data = in.read_text();
  if (in.ok()) schemas_.try_emplace(id, std::move(schema));
  return in.ok();
}

bool McapReader::parse_channel(std::span<const std::uint8_t> content) {
  FieldReader in(content);
  McapChannel channel;
  channel.id = in.read<std::uint16_t>();
  channel.schema = in.read<std::uint16_t>();
  channel.topic = in.read_text();
  channel.encoding = in.read_text();
  channel.metadata = in.read_map();
  if (in.ok()) channels_.try_emplace(channel.id, std::move(channel));
  return in.ok();
}

bool McapReader::parse_metadata(std::span<const std::uint8_t> content) {
  FieldReader in(content);
  std::string name = in.read_text();
  TextMap values = in.read_map();
  if (in.ok()) metadata_[std::move(name)] = std::move(values);
  return in.ok();
}

bool McapReader::parse_attachment(std::span<const std::uint8_t> content, std::uint64_t offset) {
  FieldReader in(content);
  in.read_bytes(8 + 8);
  std::string name = in.read_text();
  in.read_text();
  const std::span<const std::uint8_t> data = in.read_bytes(in.read<std::uint64_t>());
  const std::size_t covered = in.position();
  const auto crc = in.read<std::uint32_t>();
  if (!in.ok()) return false;
  if (crc != 0 && calc_crc32(content.first(covered)) != crc) {
    warn_damaged(offset, "attachment '" + name + "'");
    return true;
  }
  attachments_[std::move(name)].assign(reinterpret_cast<const char*>(data.data()), data.size());
  return true;
}

bool McapReader::load_chunk(const Piece& piece, ByteBuffer& out) {
  Head head;
  if (piece.offset > file_size_ || !read_head(piece.offset, head) ||
      head.opcode != Opcode::kChunk || head.length + kRecordHeadSize != piece.length ||
      !read_at(piece.offset + kRecordHeadSize, head.length, record_)) {
    warn_damaged(piece.offset, "chunk");
    return false;
  }
  FieldReader in(record_.view());
  in.read_bytes(8 + 8);
  const auto uncompressed_size = in.read<std::uint64_t>();
  const auto crc = in.read<std::uint32_t>();
  const std::string compression = in.read_text();
  const std::span<const std::uint8_t> records = in.read_bytes(in.read<std::uint64_t>());
  if (!in.ok() || !decompress(compression, records, uncompressed_size, out) ||
      (crc != 0 && calc_crc32(out.view()) != crc)) {
    warn_damaged(piece.offset, "chunk");
    return false;
  }
  return true;
}

void McapReader::warn_damaged(std::uint64_t offset, const std::string& what) {
  if (!damaged_.insert(offset).second) return;
  warnings_.push_back(
      fmt::format("{}: the {} at byte {} is damaged and was skipped", name_, what, offset));
}

void McapReader::for_each_message(const std::set<std::uint16_t>& channels,
                                  const std::function<void(const McapMessage&)>& callback) {
  // A local buffer, since the callback may read another topic.
  ByteBuffer records_of_piece;
  std::vector<bool> is_wanted(std::numeric_limits<std::uint16_t>::max() + std::size_t{1}, false);
  for (const std::uint16_t id : channels) is_wanted[id] = true;
  for (const Piece& piece : pieces_) {
    const bool wanted = std::ranges::any_of(
        channels, [&](std::uint16_t id) { return piece.channels.contains(id); });
    if (!wanted) continue;
    if (piece.is_chunk ? !load_chunk(piece, records_of_piece)
                       : !read_at(piece.offset, piece.length, records_of_piece)) {
      continue;
    }
    FieldReader records(records_of_piece.view());
    RecordView record;
    McapMessage message;
    while (read_record(records, record)) {
      if (record.opcode != Opcode::kMessage || !parse_message(record.content, message)) continue;
      if (is_wanted[message.channel]) callback(message);
    }
  }
}

}  // namespace vinerow::record
