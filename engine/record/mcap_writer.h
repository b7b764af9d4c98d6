#pragma once
/// Writer of MCAP files at the level of records. It handles chunks, indexes and checksums, and does
/// not know signals.
///
/// Closed chunks are handed to the system at once: a killed process loses only the open chunk. A
/// machine that loses power may lose more, since the writer does not wait for the disk.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/record/byte_buffer.h"
#include "engine/record/compression.h"
#include "engine/record/mcap_format.h"

namespace vinerow::record {

class McapWriter {
 public:
  /// @throws ConfigError, WriteError when the file cannot be created or the compression is unknown
  McapWriter(const std::filesystem::path& file, const std::string& compression,
             std::size_t chunk_bytes, std::string_view profile, std::string_view library);
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  void add_metadata(const std::string& name, const TextMap& values);
  /// @returns id >= 1
  std::uint16_t add_schema(const std::string& name, const std::string& encoding,
                           const std::string& data);
  /// @returns id >= 1
  std::uint16_t add_channel(std::uint16_t schema, const std::string& topic,
                            const std::string& encoding, const TextMap& metadata);
  /// Closes the open chunk first, so that the file's order is the order of the calls.
  void add_attachment(const std::string& name, const std::string& media_type,
                      std::string_view content);

  /// Starts a message; add its bytes to the returned buffer, then call end_message().
  ByteBuffer& start_message(std::uint16_t channel, std::uint64_t log_time,
                            std::uint64_t publish_time);
  void end_message();

  /// Bytes in the open chunk, before compression.
  std::size_t open_bytes() const { return chunk_.size(); }
  /// Writes the open chunk and hands it to the system.
  void close_chunk();
  /// Closes the chunk, writes summary and footer, closes the file.
  void finish();

  /// Reason of the first failed write ("the disk is full"), or "". Nothing is written after a
  /// failure.
  const std::string& failure() const { return failure_; }
  std::uint64_t bytes_written() const { return bytes_written_; }
  std::uint64_t message_count() const { return message_count_; }

 private:
  struct IndexEntry {
    std::uint64_t log_time;
    std::uint64_t offset;
  };
  struct Channel {
    std::uint64_t message_count = 0;
    std::vector<IndexEntry> index;  ///< of the open chunk
  };
  struct ChunkSummary {
    std::uint64_t start_time, end_time, offset, length;
    std::vector<std::pair<std::uint16_t, std::uint64_t>> index_offsets;
    std::uint64_t index_length, compressed_size, uncompressed_size;
  };

  void write_record();
  void write(std::span<const std::uint8_t> bytes);
  std::uint64_t add_summary_group(Opcode opcode, std::uint64_t start);
  void add_statistics();

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_{nullptr, &std::fclose};
  Compressor compressor_;
  std::string failure_;
  std::uint64_t bytes_written_ = 0;
  std::uint32_t data_crc_ = 0;
  ByteBuffer scratch_;  ///< one record outside a chunk

  ByteBuffer chunk_;
  std::size_t message_start_ = 0;
  std::uint64_t chunk_start_time_ = 0;
  std::uint64_t chunk_end_time_ = 0;

  std::vector<Channel> channels_;  ///< [id - 1]
  std::uint16_t schema_count_ = 0;
  std::uint32_t attachment_count_ = 0;
  std::uint32_t metadata_count_ = 0;
  std::uint64_t message_count_ = 0;
  std::uint64_t start_time_ = 0;
  std::uint64_t end_time_ = 0;
  std::vector<ChunkSummary> chunks_;
  // The summary repeats these records; they are kept as written.
  ByteBuffer schema_records_, channel_records_, attachment_indexes_, metadata_indexes_;
  ByteBuffer summary_offsets_;
};

}  // namespace vinerow::record
