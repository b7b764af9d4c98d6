#include "engine/imaging/png_encoder.h"

#include <libdeflate.h>

#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include "engine/core/check.h"

namespace vinerow::imaging {
namespace {

/// libdeflate's fastest. The next level takes half as long again and saves less than 1 %.
constexpr int kQuickest = 1;

void append_u32(std::string& out, std::size_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xffu);
}

/// Length, type, data, and the checksum of type and data.
void append_chunk(std::string& out, std::string_view type, std::string_view data) {
  append_u32(out, data.size());
  const std::size_t begin = out.size();
  out.append(type).append(data);
  append_u32(out, libdeflate_crc32(0, out.data() + begin, out.size() - begin));
}

std::string header_of(const PngForm& form) {
  std::string header;
  append_u32(header, static_cast<std::size_t>(form.width));
  append_u32(header, static_cast<std::size_t>(form.height));
  constexpr char kGrey = 0, kRgb = 2;
  header += static_cast<char>(8 * form.bytes_per_channel);
  header += form.channels == 3 ? kRgb : kGrey;
  header.append(3, '\0');  // deflate, one filter for each row, rows in order
  return header;
}

/// Each row after the number of its filter: 0 as it is, 1 differences to the pixel on the left.
/// Numbers of two bytes have the higher one first.
std::vector<std::uint8_t> filtered(const PngForm& form, std::span<const std::uint8_t> rows) {
  const std::size_t row_bytes = form.row_bytes();
  const auto pixel_bytes = static_cast<std::size_t>(form.channels * form.bytes_per_channel);
  std::vector<std::uint8_t> out((1 + row_bytes) * static_cast<std::size_t>(form.height));
  std::vector<std::uint8_t> swapped(form.bytes_per_channel == 2 ? row_bytes : 0);
  std::uint8_t* to = out.data();
  for (const std::uint8_t* from = rows.data(); from != rows.data() + rows.size();
       from += row_bytes) {
    const std::uint8_t* row = from;
    if (!swapped.empty()) {
      for (std::size_t i = 0; i < row_bytes; ++i) swapped[i] = from[i ^ 1u];
      row = swapped.data();
    }
    *to++ = form.differences ? 1 : 0;
    const std::size_t first = form.differences ? pixel_bytes : row_bytes;
    for (std::size_t i = 0; i < first; ++i) to[i] = row[i];
    for (std::size_t i = first; i < row_bytes; ++i) {
      to[i] = static_cast<std::uint8_t>(row[i] - row[i - pixel_bytes]);
    }
    to += row_bytes;
  }
  return out;
}

std::string compressed(std::span<const std::uint8_t> bytes) {
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(kQuickest), &libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::string out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
  out.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(),
                                      out.size()));
  VINEROW_DEMAND(!out.empty());  // the bound is enough for any bytes
  return out;
}

}  // namespace

std::string encode_png_rows(const PngForm& form, std::span<const std::uint8_t> rows,
                            const std::map<std::string, std::string>& words) {
  VINEROW_DEMAND(form.width >= 1 && form.height >= 1);
  VINEROW_DEMAND(form.channels == 1 || form.channels == 3);
  VINEROW_DEMAND(form.bytes_per_channel == 1 || form.bytes_per_channel == 2);
  VINEROW_DEMAND(rows.size() == form.row_bytes() * static_cast<std::size_t>(form.height));
  const std::string pixels = compressed(filtered(form, rows));
  std::string out = "\x89PNG\r\n\x1a\n";
  out.reserve(pixels.size() + 1024);
  append_chunk(out, "IHDR", header_of(form));
  for (const auto& [keyword, text] : words) {
    append_chunk(out, "tEXt", keyword + '\0' + text);
  }
  append_chunk(out, "IDAT", pixels);
  append_chunk(out, "IEND", "");
  return out;
}

}  // namespace vinerow::imaging
