#include "engine/record/compression.h"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <new>

#include "engine/core/check.h"
#include "engine/core/error.h"

namespace vinerow::record {
namespace {

// Level 3 (the library's default): log data is mostly noise in the low bits of doubles, which no
// level compresses; level 3 already finds the repetitions in the rest. Its tables are smaller than
// by default, so that they fit into the first cache: a third less time for 0 to 0.4 % more bytes.
constexpr int kZstdLevel = 3;
constexpr int kZstdTableLog = 13;

// Larger chunks are treated as damaged.
constexpr std::uint64_t kLargestChunk = std::uint64_t{1} << 30;

// First size of the output if the compressed bytes do not state it.
constexpr std::size_t kFirstOutput = std::size_t{1} << 20;

/// Enlarges the output buffer; false if the size stated by the chunk is already reached.
bool grow(ByteBuffer& out, std::size_t filled, std::uint64_t size) {
  if (filled >= size) return false;
  out.resize(static_cast<std::size_t>(
      std::min<std::uint64_t>(size, std::max<std::uint64_t>(2 * filled, kFirstOutput))));
  return true;
}

bool decompress_zstd(std::span<const std::uint8_t> in, std::uint64_t size, ByteBuffer& out) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  const unsigned long long stated = ZSTD_getFrameContentSize(in.data(), in.size());
  if (stated == ZSTD_CONTENTSIZE_ERROR) return false;
  if (stated != ZSTD_CONTENTSIZE_UNKNOWN) {
    if (stated != size) return false;
    out.resize(size);
    return ZSTD_decompressDCtx(context.get(), out.data(), size, in.data(), in.size()) == size;
  }
  ZSTD_inBuffer source{in.data(), in.size(), 0};
  std::size_t filled = 0;
  while (true) {
    if (filled == out.size() && !grow(out, filled, size)) break;
    ZSTD_outBuffer target{out.data(), out.size(), filled};
    const std::size_t hint = ZSTD_decompressStream(context.get(), &target, &source);
    if (ZSTD_isError(hint)) return false;
    const bool stuck = target.pos == filled && source.pos == source.size;
    filled = target.pos;
    if (hint == 0 || stuck) break;
  }
  out.resize(filled);
  return filled == size;
}

bool decompress_lz4(std::span<const std::uint8_t> in, std::uint64_t size, ByteBuffer& out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  std::size_t used = 0;
  std::size_t filled = 0;
  while (true) {
    // When the output is complete, LZ4 needs one more call to read the end mark.
    if (filled == out.size()) grow(out, filled, size);
    std::size_t out_size = out.size() - filled;
    std::size_t in_size = in.size() - used;
    const std::size_t hint = LZ4F_decompress(context.get(), out.data() + filled, &out_size,
                                             in.data() + used, &in_size, nullptr);
    if (LZ4F_isError(hint)) return false;
    filled += out_size;
    used += in_size;
    if (hint == 0) break;
    if (out_size == 0 && in_size == 0) return false;
  }
  out.resize(filled);
  return filled == size;
}

}  // namespace

struct Compressor::State {
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> zstd{nullptr, &ZSTD_freeCCtx};
  std::unique_ptr<LZ4F_cctx, decltype(&LZ4F_freeCompressionContext)> lz4{
      nullptr, &LZ4F_freeCompressionContext};
};

Compressor::Compressor(const std::string& name) : state_(std::make_unique<State>()) {
  if (name == "zstd") {
    state_->zstd.reset(ZSTD_createCCtx());
    if (!state_->zstd) throw std::bad_alloc();
    ZSTD_CCtx_setParameter(state_->zstd.get(), ZSTD_c_compressionLevel, kZstdLevel);
    ZSTD_CCtx_setParameter(state_->zstd.get(), ZSTD_c_hashLog, kZstdTableLog);
    ZSTD_CCtx_setParameter(state_->zstd.get(), ZSTD_c_chainLog, kZstdTableLog);
  } else if (name == "lz4") {
    LZ4F_cctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createCompressionContext(&context, LZ4F_VERSION))) throw std::bad_alloc();
    state_->lz4.reset(context);
  } else if (name != "none") {
    throw ConfigError("compression of the log = '" + name + "', must be zstd, lz4 or none");
  }
  if (name != "none") mcap_name_ = name;
}

Compressor::~Compressor() = default;

std::span<const std::uint8_t> Compressor::compress(std::span<const std::uint8_t> in) {
  if (state_->zstd) {
    out_.resize(ZSTD_compressBound(in.size()));
    const std::size_t size =
        ZSTD_compress2(state_->zstd.get(), out_.data(), out_.size(), in.data(), in.size());
    VINEROW_DEMAND(!ZSTD_isError(size));
    out_.resize(size);
    return out_.view();
  }
  if (state_->lz4) {
    LZ4F_preferences_t preferences{};
    preferences.frameInfo.contentSize = in.size();
    preferences.frameInfo.blockSizeID = LZ4F_max4MB;
    preferences.autoFlush = 1;
    LZ4F_cctx* context = state_->lz4.get();
    out_.resize(LZ4F_compressFrameBound(in.size(), &preferences));
    std::size_t size = 0;
    const auto add = [&](std::size_t result) {
      VINEROW_DEMAND(!LZ4F_isError(result));
      size += result;
    };
    add(LZ4F_compressBegin(context, out_.data(), out_.size(), &preferences));
    add(LZ4F_compressUpdate(context, out_.data() + size, out_.size() - size, in.data(), in.size(),
                            nullptr));
    add(LZ4F_compressEnd(context, out_.data() + size, out_.size() - size, nullptr));
    out_.resize(size);
    return out_.view();
  }
  return in;
}

bool decompress(std::string_view mcap_name, std::span<const std::uint8_t> in, std::uint64_t size,
                ByteBuffer& out) {
  out.clear();
  if (size > kLargestChunk) return false;
  if (mcap_name == "zstd") return decompress_zstd(in, size, out);
  if (mcap_name == "lz4") return decompress_lz4(in, size, out);
  if (!mcap_name.empty() || in.size() != size) return false;
  out.add_bytes(in.data(), in.size());
  return true;
}

}  // namespace vinerow::record
