#pragma once
/// Reader of MCAP files at the level of records, for complete and damaged files. It handles chunks,
/// indexes and checksums, and does not know signals.
///
/// A complete file is opened by its summary. If the summary is missing or damaged (a killed run, a
/// bad copy), the records are scanned from the front, up to the first broken one. A damaged chunk
/// in the middle is skipped and reported. No content of a file can crash the reader or make it
/// allocate much more memory than the size of the file.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "engine/record/byte_buffer.h"
#include "engine/record/mcap_format.h"

namespace vinerow::record {

struct McapSchema {
  std::string name;
  std::string encoding;
  std::string data;
};

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;
  std::string topic;
  std::string encoding;
  TextMap metadata;
  std::uint64_t messages = 0;
};

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;
  std::uint64_t publish_time = 0;
  std::span<const std::uint8_t> data;
};

class McapReader {
 public:
  /// @throws ConfigError "x.mcap: cannot be read: ..." | "x.mcap: not an MCAP file" | "x.mcap: cut
  /// off inside its first record"
  explicit McapReader(const std::filesystem::path& file);

  bool complete() const { return complete_; }
  std::uint64_t file_size() const { return file_size_; }
  std::uint64_t message_count() const { return message_count_; }
  std::uint64_t start_time() const { return start_time_; }
  std::uint64_t end_time() const { return end_time_; }
  const std::string& profile() const { return profile_; }
  const std::string& library() const { return library_; }
  const std::map<std::uint16_t, McapSchema>& schemas() const { return schemas_; }
  const std::map<std::uint16_t, McapChannel>& channels() const { return channels_; }
  /// Record name -> values.
  const std::map<std::string, TextMap>& metadata() const { return metadata_; }
  /// File name -> content, for attachments with a correct checksum.
  const std::map<std::string, std::string>& attachments() const { return attachments_; }

  /// One sentence for each skipped damaged piece; grows while messages are read.
  const std::vector<std::string>& warnings() const { return warnings_; }
  std::uint64_t damaged_chunks() const { return damaged_.size(); }

  /// Calls back for each message of these channels in file order. The data is valid until the
  /// callback returns.
  void for_each_message(const std::set<std::uint16_t>& channels,
                        const std::function<void(const McapMessage&)>& callback);

 private:
  /// A chunk, or consecutive messages outside chunks.
  struct Piece {
    std::uint64_t offset = 0;  ///< of the first record
    std::uint64_t length = 0;
    bool is_chunk = true;
    std::set<std::uint16_t> channels;
  };
  struct Head {
    Opcode opcode{};
    std::uint64_t length = 0;  ///< of the content
  };

  bool read_at(std::uint64_t offset, std::uint64_t size, ByteBuffer& out);
  bool read_head(std::uint64_t offset, Head& head);
  bool load_summary();
  bool parse_summary(std::span<const std::uint8_t> records);
  bool load_indexed_records(const std::vector<std::uint64_t>& offsets, Opcode opcode);
  void scan();
  void scan_message(const McapMessage& message);
  void forget_summary();

  bool parse_schema(std::span<const std::uint8_t> content);
  bool parse_channel(std::span<const std::uint8_t> content);
  bool parse_metadata(std::span<const std::uint8_t> content);
  bool parse_attachment(std::span<const std::uint8_t> content, std::uint64_t offset);
  /// Loads the records of a chunk. @returns false, with a warning, if it is damaged
  bool load_chunk(const Piece& piece, ByteBuffer& out);
  void warn_damaged(std::uint64_t offset, const std::string& what);

  std::string name_;
  std::ifstream file_;
  std::uint64_t file_size_ = 0;
  std::uint64_t first_record_ = 0;  ///< offset after the header
  std::string profile_, library_;
  bool complete_ = false;
  std::uint64_t message_count_ = 0;
  std::uint64_t start_time_ = 0;
  std::uint64_t end_time_ = 0;
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::map<std::string, TextMap> metadata_;
  std::map<std::string, std::string> attachments_;
  std::vector<Piece> pieces_;
  std::vector<std::string> warnings_;
  std::set<std::uint64_t> damaged_;  ///< offsets
  ByteBuffer record_;
};

}  // namespace vinerow::record
