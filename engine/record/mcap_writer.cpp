#include "engine/record/mcap_writer.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "engine/core/check.h"
#include "engine/core/whole_file.h"
#include "engine/record/crc32.h"

namespace vinerow::record {

McapWriter::McapWriter(const std::filesystem::path& file, const std::string& compression,
                       std::size_t chunk_bytes, std::string_view profile, std::string_view library)
    : compressor_(compression) {
  file_.reset(std::fopen(file.c_str(), "wb"));
  if (!file_) {
    throw_cannot_write("log '" + file.string() + "'", errno);
  }
  // Records are assembled here; a second buffer would only delay them.
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);
  // A chunk is closed after the message that fills it.
  chunk_.reserve(chunk_bytes + chunk_bytes / 4);

  scratch_.add_bytes(kMagic.data(), kMagic.size());
  {
    const RecordScope record(scratch_, Opcode::kHeader);
    add_text(scratch_, profile);
    add_text(scratch_, library);
  }
  write_record();
}

void McapWriter::write(std::span<const std::uint8_t> bytes) {
  if (!failure_.empty() || bytes.empty()) return;
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) {
    failure_ = words_of_write_failure(errno);
    // The written part of the record would be half a chunk: truncate the file to the last complete
    // one.
    static_cast<void>(::ftruncate(::fileno(file_.get()), static_cast<off_t>(bytes_written_)));
    return;
  }
  bytes_written_ += bytes.size();
}

void McapWriter::write_record() {
  data_crc_ = calc_crc32(scratch_.view(), data_crc_);
  write(scratch_.view());
  scratch_.clear();
}

void McapWriter::add_metadata(const std::string& name, const TextMap& values) {
  const std::uint64_t offset = bytes_written_;
  {
    const RecordScope record(scratch_, Opcode::kMetadata);
    add_text(scratch_, name);
    add_map(scratch_, values);
  }
  const std::uint64_t length = scratch_.size();
  write_record();
  ++metadata_count_;

  const RecordScope record(metadata_indexes_, Opcode::kMetadataIndex);
  metadata_indexes_.add(offset);
  metadata_indexes_.add(length);
  add_text(metadata_indexes_, name);
}

std::uint16_t McapWriter::add_schema(const std::string& name, const std::string& encoding,
                                     const std::string& data) {
  ++schema_count_;
  {
    const RecordScope record(scratch_, Opcode::kSchema);
    scratch_.add(schema_count_);
    add_text(scratch_, name);
    add_text(scratch_, encoding);
    add_text(scratch_, data);
  }
  schema_records_.add_bytes(scratch_.data(), scratch_.size());
  write_record();
  return schema_count_;
}

std::uint16_t McapWriter::add_channel(std::uint16_t schema, const std::string& topic,
                                      const std::string& encoding, const TextMap& metadata) {
  channels_.emplace_back();
  VINEROW_DEMAND(channels_.size() < 0xFFFF);
  const auto id = static_cast<std::uint16_t>(channels_.size());
  {
    const RecordScope record(scratch_, Opcode::kChannel);
    scratch_.add(id);
    scratch_.add(schema);
    add_text(scratch_, topic);
    add_text(scratch_, encoding);
    add_map(scratch_, metadata);
  }
  channel_records_.add_bytes(scratch_.data(), scratch_.size());
  write_record();
  return id;
}

void McapWriter::add_attachment(const std::string& name, const std::string& media_type,
                                std::string_view content) {
  close_chunk();
  const std::uint64_t offset = bytes_written_;
  const std::uint64_t log_time = end_time_;
  // No creation time, since a log does not depend on wall time.
  const std::uint64_t create_time = 0;
  {
    const RecordScope record(scratch_, Opcode::kAttachment);
    scratch_.add(log_time);
    scratch_.add(create_time);
    add_text(scratch_, name);
    add_text(scratch_, media_type);
    scratch_.add(static_cast<std::uint64_t>(content.size()));
    scratch_.add_bytes(content.data(), content.size());
    scratch_.add(calc_crc32(scratch_.view().subspan(kRecordHeadSize)));
  }
  const std::uint64_t length = scratch_.size();
  write_record();
  ++attachment_count_;

  const RecordScope record(attachment_indexes_, Opcode::kAttachmentIndex);
  attachment_indexes_.add(offset);
  attachment_indexes_.add(length);
  attachment_indexes_.add(log_time);
  attachment_indexes_.add(create_time);
  attachment_indexes_.add(static_cast<std::uint64_t>(content.size()));
  add_text(attachment_indexes_, name);
  add_text(attachment_indexes_, media_type);
}

ByteBuffer& McapWriter::start_message(std::uint16_t channel_id, std::uint64_t log_time,
                                      std::uint64_t publish_time) {
  Channel& channel = channels_[channel_id - 1];
  message_start_ = chunk_.size();
  chunk_start_time_ = chunk_.empty() ? log_time : std::min(chunk_start_time_, log_time);
  chunk_end_time_ = chunk_.empty() ? log_time : std::max(chunk_end_time_, log_time);
  start_time_ = message_count_ == 0 ? log_time : std::min(start_time_, log_time);
  end_time_ = message_count_ == 0 ? log_time : std::max(end_time_, log_time);

  channel.index.push_back({log_time, message_start_});
  ++message_count_;
  chunk_.add(Opcode::kMessage);
  chunk_.add(std::uint64_t{0});
  chunk_.add(channel_id);
  // Sequence: 0 = not used, as in rosbag2. A count would cost two bytes a message after
  // compression.
  chunk_.add(std::uint32_t{0});
  ++channel.message_count;
  chunk_.add(log_time);
  chunk_.add(publish_time);
  return chunk_;
}

void McapWriter::end_message() {
  chunk_.put(message_start_ + 1,
             static_cast<std::uint64_t>(chunk_.size() - message_start_ - kRecordHeadSize));
}

void McapWriter::close_chunk() {
  if (chunk_.empty()) return;
  const std::span<const std::uint8_t> compressed = compressor_.compress(chunk_.view());
  ChunkSummary& summary = chunks_.emplace_back();
  summary.start_time = chunk_start_time_;
  summary.end_time = chunk_end_time_;
  summary.offset = bytes_written_;
  summary.compressed_size = compressed.size();
  summary.uncompressed_size = chunk_.size();
  {
    const RecordScope record(scratch_, Opcode::kChunk);
    scratch_.add(chunk_start_time_);
    scratch_.add(chunk_end_time_);
    scratch_.add(summary.uncompressed_size);
    scratch_.add(calc_crc32(chunk_.view()));
    add_text(scratch_, compressor_.mcap_name());
    scratch_.add(summary.compressed_size);
    scratch_.add_bytes(compressed.data(), compressed.size());
  }
  summary.length = scratch_.size();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    std::vector<IndexEntry>& index = channels_[i].index;
    if (index.empty()) continue;
    const auto id = static_cast<std::uint16_t>(i + 1);
    summary.index_offsets.emplace_back(id, summary.offset + scratch_.size());
    const RecordScope record(scratch_, Opcode::kMessageIndex);
    scratch_.add(id);
    scratch_.add(static_cast<std::uint32_t>(index.size() * sizeof(IndexEntry)));
    scratch_.add_bytes(index.data(), index.size() * sizeof(IndexEntry));
    index.clear();
  }
  summary.index_length = scratch_.size() - summary.length;
  // A single write: a reader of a growing file sees the chunk with its indexes or not at all.
  write_record();
  chunk_.clear();
}

std::uint64_t McapWriter::add_summary_group(Opcode opcode, std::uint64_t start) {
  const std::uint64_t end = bytes_written_ + scratch_.size();
  if (end == start) return end;
  const RecordScope record(summary_offsets_, Opcode::kSummaryOffset);
  summary_offsets_.add(opcode);
  summary_offsets_.add(start);
  summary_offsets_.add(end - start);
  return end;
}

void McapWriter::add_statistics() {
  const RecordScope record(scratch_, Opcode::kStatistics);
  scratch_.add(message_count_);
  scratch_.add(schema_count_);
  scratch_.add(static_cast<std::uint32_t>(channels_.size()));
  scratch_.add(attachment_count_);
  scratch_.add(metadata_count_);
  scratch_.add(static_cast<std::uint32_t>(chunks_.size()));
  scratch_.add(start_time_);
  scratch_.add(end_time_);
  scratch_.add(static_cast<std::uint32_t>(channels_.size() * (2 + 8)));
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    scratch_.add(static_cast<std::uint16_t>(i + 1));
    scratch_.add(channels_[i].message_count);
  }
}

void McapWriter::finish() {
  if (!file_) return;
  close_chunk();
  {
    const RecordScope record(scratch_, Opcode::kDataEnd);
    scratch_.add(data_crc_);
  }
  write_record();

  const std::uint64_t summary_start = bytes_written_;
  std::uint64_t group = summary_start;
  scratch_.add_bytes(schema_records_.data(), schema_records_.size());
  group = add_summary_group(Opcode::kSchema, group);
  scratch_.add_bytes(channel_records_.data(), channel_records_.size());
  group = add_summary_group(Opcode::kChannel, group);
  add_statistics();
  group = add_summary_group(Opcode::kStatistics, group);
  for (const ChunkSummary& chunk : chunks_) {
    const RecordScope record(scratch_, Opcode::kChunkIndex);
    scratch_.add(chunk.start_time);
    scratch_.add(chunk.end_time);
    scratch_.add(chunk.offset);
    scratch_.add(chunk.length);
    scratch_.add(static_cast<std::uint32_t>(chunk.index_offsets.size() * (2 + 8)));
    for (const auto& [channel, offset] : chunk.index_offsets) {
      scratch_.add(channel);
      scratch_.add(offset);
    }
    scratch_.add(chunk.index_length);
    add_text(scratch_, compressor_.mcap_name());
    scratch_.add(chunk.compressed_size);
    scratch_.add(chunk.uncompressed_size);
  }
  group = add_summary_group(Opcode::kChunkIndex, group);
  scratch_.add_bytes(attachment_indexes_.data(), attachment_indexes_.size());
  group = add_summary_group(Opcode::kAttachmentIndex, group);
  scratch_.add_bytes(metadata_indexes_.data(), metadata_indexes_.size());
  group = add_summary_group(Opcode::kMetadataIndex, group);
  scratch_.add_bytes(summary_offsets_.data(), summary_offsets_.size());

  // The checksum covers the summary and the footer up to the checksum itself.
  scratch_.add(Opcode::kFooter);
  scratch_.add(static_cast<std::uint64_t>(kFooterContentSize));
  scratch_.add(summary_start);
  scratch_.add(group);
  scratch_.add(calc_crc32(scratch_.view()));
  scratch_.add_bytes(kMagic.data(), kMagic.size());
  write(scratch_.view());
  scratch_.clear();
  if (std::fclose(file_.release()) != 0 && failure_.empty()) {
    failure_ = words_of_write_failure(errno);
  }
}

}  // namespace vinerow::record
