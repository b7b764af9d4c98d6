#pragma once
/// Compression of MCAP chunks: "zstd", "lz4" (the LZ4 frame format) or "" for none.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "engine/record/byte_buffer.h"

namespace vinerow::record {

class Compressor {
 public:
  /// @param name  "zstd" | "lz4" | "none"
  /// @throws ConfigError for another name
  explicit Compressor(const std::string& name);
  ~Compressor();

  /// Name of the compression in MCAP: "zstd", "lz4" or "".
  const std::string& mcap_name() const { return mcap_name_; }

  /// @returns the compressed bytes, valid until the next call (`in` itself for "none")
  std::span<const std::uint8_t> compress(std::span<const std::uint8_t> in);

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::string mcap_name_;
  ByteBuffer out_;
};

/// Decompresses chunks of Compressor and of other MCAP writers.
/// @param size  the uncompressed size that the chunk states
/// @returns false if the bytes are damaged, do not decompress to exactly `size` bytes, or the
/// compression is unknown. Memory grows with the real content, not with a damaged `size`.
bool decompress(std::string_view mcap_name, std::span<const std::uint8_t> in, std::uint64_t size,
                ByteBuffer& out);

}  // namespace vinerow::record
