#include "tools/report/jpeg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

#include "engine/core/check.h"

namespace vinerow::tools::report {
namespace {

constexpr int kBlock = 8, kCell = 16;  ///< side of a block and of a cell (with colours), pixels

using Table = std::array<int, 64>;
using Block = std::array<double, 64>;

// T.81, tables K.1 and K.2, row by row.
constexpr Table kLuminance = {16,  11,  10,  16,  24, 40, 51,  61,  12,  12,  14,  19,  26,
                              58,  60,  55,  14,  13, 16, 24,  40,  57,  69,  56,  14,  17,
                              22,  29,  51,  87,  80, 62, 18,  22,  37,  56,  68,  109, 103,
                              77,  24,  35,  55,  64, 81, 104, 113, 92,  49,  64,  78,  87,
                              103, 121, 120, 101, 72, 92, 95,  98,  112, 100, 103, 99};
constexpr Table kChrominance = {17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99,
                                24, 26, 56, 99, 99, 99, 99, 99, 47, 66, 99, 99, 99, 99, 99, 99,
                                99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99,
                                99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99};
// T.81, figure A.6: index in the block of each coefficient, in order of output.
constexpr Table kZigzag = {0,  1,  8,  16, 9,  2,  3,  10, 17, 24, 32, 25, 18, 11, 4,  5,
                           12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6,  7,  14, 21, 28,
                           35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51,
                           58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63};

/// Number of codes with 1 to 16 bits, and their values (T.81, tables K.3 to K.6).
struct CodeList {
  std::array<std::uint8_t, 16> counts;
  std::span<const std::uint8_t> symbols;
};

constexpr std::uint8_t kDcSymbols[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
constexpr std::uint8_t kLuminanceAcSymbols[] = {
    0x01, 0x02, 0x03, 0x00, 0x04, 0x11, 0x05, 0x12, 0x21, 0x31, 0x41, 0x06, 0x13, 0x51, 0x61,
    0x07, 0x22, 0x71, 0x14, 0x32, 0x81, 0x91, 0xa1, 0x08, 0x23, 0x42, 0xb1, 0xc1, 0x15, 0x52,
    0xd1, 0xf0, 0x24, 0x33, 0x62, 0x72, 0x82, 0x09, 0x0a, 0x16, 0x17, 0x18, 0x19, 0x1a, 0x25,
    0x26, 0x27, 0x28, 0x29, 0x2a, 0x34, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3a, 0x43, 0x44, 0x45,
    0x46, 0x47, 0x48, 0x49, 0x4a, 0x53, 0x54, 0x55, 0x56, 0x57, 0x58, 0x59, 0x5a, 0x63, 0x64,
    0x65, 0x66, 0x67, 0x68, 0x69, 0x6a, 0x73, 0x74, 0x75, 0x76, 0x77, 0x78, 0x79, 0x7a, 0x83,
    0x84, 0x85, 0x86, 0x87, 0x88, 0x89, 0x8a, 0x92, 0x93, 0x94, 0x95, 0x96, 0x97, 0x98, 0x99,
    0x9a, 0xa2, 0xa3, 0xa4, 0xa5, 0xa6, 0xa7, 0xa8, 0xa9, 0xaa, 0xb2, 0xb3, 0xb4, 0xb5, 0xb6,
    0xb7, 0xb8, 0xb9, 0xba, 0xc2, 0xc3, 0xc4, 0xc5, 0xc6, 0xc7, 0xc8, 0xc9, 0xca, 0xd2, 0xd3,
    0xd4, 0xd5, 0xd6, 0xd7, 0xd8, 0xd9, 0xda, 0xe1, 0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7, 0xe8,
    0xe9, 0xea, 0xf1, 0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8, 0xf9, 0xfa};
constexpr std::uint8_t kChrominanceAcSymbols[] = {
    0x00, 0x01, 0x02, 0x03, 0x11, 0x04, 0x05, 0x21, 0x31, 0x06, 0x12, 0x41, 0x51, 0x07, 0x61,
    0x71, 0x13, 0x22, 0x32, 0x81, 0x08, 0x14, 0x42, 0x91, 0xa1, 0xb1, 0xc1, 0x09, 0x23, 0x33,
    0x52, 0xf0, 0x15, 0x62, 0x72, 0xd1, 0x0a, 0x16, 0x24, 0x34, 0xe1, 0x25, 0xf1, 0x17, 0x18,
    0x19, 0x1a, 0x26, 0x27, 0x28, 0x29, 0x2a, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3a, 0x43, 0x44,
    0x45, 0x46, 0x47, 0x48, 0x49, 0x4a, 0x53, 0x54, 0x55, 0x56, 0x57, 0x58, 0x59, 0x5a, 0x63,
    0x64, 0x65, 0x66, 0x67, 0x68, 0x69, 0x6a, 0x73, 0x74, 0x75, 0x76, 0x77, 0x78, 0x79, 0x7a,
    0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88, 0x89, 0x8a, 0x92, 0x93, 0x94, 0x95, 0x96, 0x97,
    0x98, 0x99, 0x9a, 0xa2, 0xa3, 0xa4, 0xa5, 0xa6, 0xa7, 0xa8, 0xa9, 0xaa, 0xb2, 0xb3, 0xb4,
    0xb5, 0xb6, 0xb7, 0xb8, 0xb9, 0xba, 0xc2, 0xc3, 0xc4, 0xc5, 0xc6, 0xc7, 0xc8, 0xc9, 0xca,
    0xd2, 0xd3, 0xd4, 0xd5, 0xd6, 0xd7, 0xd8, 0xd9, 0xda, 0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7,
    0xe8, 0xe9, 0xea, 0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8, 0xf9, 0xfa};
const CodeList kLuminanceDc = {{0, 1, 5, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0}, kDcSymbols};
const CodeList kChrominanceDc = {{0, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0}, kDcSymbols};
const CodeList kLuminanceAc = {{0, 2, 1, 3, 3, 2, 4, 3, 5, 5, 4, 4, 0, 0, 1, 0x7d},
                               kLuminanceAcSymbols};
const CodeList kChrominanceAc = {{0, 2, 1, 2, 4, 4, 3, 4, 7, 5, 4, 4, 0, 1, 2, 0x77},
                                 kChrominanceAcSymbols};

struct Code {
  std::uint32_t bits = 0;
  int length = 0;
};

/// Huffman codes from a list (T.81, annex C): codes of one length are consecutive.
std::array<Code, 256> codes_of(const CodeList& list) {
  std::array<Code, 256> codes;
  std::uint32_t next = 0;
  std::size_t at = 0;
  for (int length = 1; length <= 16; ++length) {
    for (int k = 0; k < list.counts[static_cast<std::size_t>(length - 1)]; ++k) {
      codes[list.symbols[at++]] = {next++, length};
    }
    next <<= 1;
  }
  return codes;
}

class BitWriter {
 public:
  explicit BitWriter(std::string& out) : out_(out) {}

  void put(std::uint32_t bits, int length) {
    for (int i = length - 1; i >= 0; --i) {
      byte_ = byte_ << 1 | (bits >> i & 1u);
      if (++filled_ == 8) flush();
    }
  }
  void put(const Code& code) { put(code.bits, code.length); }
  /// Fills the last byte with ones.
  void finish() {
    while (filled_ != 0) put(1, 1);
  }

 private:
  void flush() {
    out_ += static_cast<char>(byte_);
    // 0xFF would start a marker, so a zero byte follows it.
    if (byte_ == 0xFF) out_ += '\0';
    byte_ = 0;
    filled_ = 0;
  }

  std::string& out_;
  std::uint32_t byte_ = 0;
  int filled_ = 0;
};

/// Colour component Y, Cb or Cr: its tables, and the DC coefficient of the previous block.
struct Component {
  Table quanta;
  std::array<Code, 256> dc, ac;
  int last_dc = 0;
};

Table quanta_of(const Table& table, int quality) {
  const int scale = quality < 50 ? 5000 / quality : 200 - 2 * quality;
  Table quanta;
  for (std::size_t i = 0; i < 64; ++i) {
    quanta[i] = std::clamp((table[i] * scale + 50) / 100, 1, 255);
  }
  return quanta;
}

/// basis[u][x] = c(u) / 2 · cos((2x + 1) u π / 16) of T.81, A.3.3.
const Block& cosines() {
  static const Block basis = [] {
    Block b;
    for (int u = 0; u < kBlock; ++u) {
      for (int x = 0; x < kBlock; ++x) {
        const double c = u == 0 ? std::numbers::sqrt2 / 2.0 : 1.0;
        b[static_cast<std::size_t>(kBlock * u + x)] =
            0.5 * c * std::cos((2 * x + 1) * u * std::numbers::pi / 16.0);
      }
    }
    return b;
  }();
  return basis;
}

Block transformed(const Block& block) {
  const Block& basis = cosines();
  Block rows, out;
  for (std::size_t y = 0; y < 8; ++y) {
    for (std::size_t u = 0; u < 8; ++u) {
      double sum = 0.0;
      for (std::size_t x = 0; x < 8; ++x) sum += basis[8 * u + x] * block[8 * y + x];
      rows[8 * y + u] = sum;
    }
  }
  for (std::size_t v = 0; v < 8; ++v) {
    for (std::size_t u = 0; u < 8; ++u) {
      double sum = 0.0;
      for (std::size_t y = 0; y < 8; ++y) sum += basis[8 * v + y] * rows[8 * y + u];
      out[8 * v + u] = sum;
    }
  }
  return out;
}

int size_of(int value) {
  int size = 0;
  for (int rest = std::abs(value); rest != 0; rest >>= 1) ++size;
  return size;
}

/// Bits that follow a size: those of the value, or of value - 1 if it is negative (T.81, F.1.2.1).
void put_value(int value, int size, BitWriter& out) {
  out.put(static_cast<std::uint32_t>(value < 0 ? value + (1 << size) - 1 : value), size);
}

void put_block(const Block& block, Component& component, BitWriter& out) {
  const Block frequencies = transformed(block);
  Table values;
  for (std::size_t k = 0; k < 64; ++k) {
    const auto at = static_cast<std::size_t>(kZigzag[k]);
    values[k] = static_cast<int>(std::lround(frequencies[at] / component.quanta[at]));
  }
  const int step = values[0] - component.last_dc, step_size = size_of(step);
  component.last_dc = values[0];
  out.put(component.dc[static_cast<std::size_t>(step_size)]);
  put_value(step, step_size, out);
  int zeros = 0;
  for (std::size_t k = 1; k < 64; ++k) {
    if (values[k] == 0) {
      ++zeros;
      continue;
    }
    for (; zeros > 15; zeros -= 16) out.put(component.ac[0xF0]);
    const int size = size_of(values[k]);
    out.put(component.ac[static_cast<std::size_t>(zeros << 4 | size)]);
    put_value(values[k], size, out);
    zeros = 0;
  }
  if (zeros > 0) out.put(component.ac[0]);
}

void put_word(std::string& out, int value) {
  out += static_cast<char>(value >> 8 & 255);
  out += static_cast<char>(value & 255);
}

void put_quanta(std::string& out, int number, const Table& quanta) {
  out += "\xFF\xDB";
  put_word(out, 67);
  out += static_cast<char>(number);
  for (const int at : kZigzag) out += static_cast<char>(quanta[static_cast<std::size_t>(at)]);
}

void put_codes(std::string& out, int kind_and_number, const CodeList& list) {
  out += "\xFF\xC4";
  put_word(out, static_cast<int>(19 + list.symbols.size()));
  out += static_cast<char>(kind_and_number);
  for (const std::uint8_t count : list.counts) out += static_cast<char>(count);
  for (const std::uint8_t symbol : list.symbols) out += static_cast<char>(symbol);
}

std::string headers(const render::Pixels& pixels, const Table& luminance,
                    const Table& chrominance) {
  std::string out = "\xFF\xD8\xFF\xE0";
  put_word(out, 16);
  out.append("JFIF\0\1\1\0\0\1\0\1\0\0", 14);
  put_quanta(out, 0, luminance);
  put_quanta(out, 1, chrominance);
  out += "\xFF\xC0";
  put_word(out, 17);
  out += '\x08';
  put_word(out, pixels.height);
  put_word(out, pixels.width);
  // Three components: number, horizontal and vertical samples per cell, quantisation table.
  out.append("\3\1\x22\0\2\x11\1\3\x11\1", 10);
  put_codes(out, 0x00, kLuminanceDc);
  put_codes(out, 0x10, kLuminanceAc);
  put_codes(out, 0x01, kChrominanceDc);
  put_codes(out, 0x11, kChrominanceAc);
  out += "\xFF\xDA";
  put_word(out, 12);
  out.append("\3\1\0\2\x11\3\x11\0\x3F\0", 10);
  return out;
}

/// Cell of 16 x 16 pixels in the YCbCr of JFIF. Beyond the picture its last pixels repeat.
struct Cell {
  std::array<Block, 4> y;
  Block cb{}, cr{};

  Cell(const render::Pixels& pixels, int left, int top) {
    for (int j = 0; j < kCell; ++j) {
      for (int i = 0; i < kCell; ++i) {
        const std::uint8_t* p =
            pixels.at(std::min(left + i, pixels.width - 1), std::min(top + j, pixels.height - 1));
        const double r = p[0], g = p[1], b = p[2];
        const auto block = static_cast<std::size_t>(2 * (j / kBlock) + i / kBlock);
        const auto at = static_cast<std::size_t>(kBlock * (j % kBlock) + i % kBlock);
        const auto half = static_cast<std::size_t>(kBlock * (j / 2) + i / 2);
        y[block][at] = 0.299 * r + 0.587 * g + 0.114 * b - 128.0;
        cb[half] += 0.25 * (-0.168736 * r - 0.331264 * g + 0.5 * b);
        cr[half] += 0.25 * (0.5 * r - 0.418688 * g - 0.081312 * b);
      }
    }
  }
};

}  // namespace

std::string encode_jpeg(const render::Pixels& pixels, int quality) {
  VINEROW_DEMAND(pixels.width > 0 && pixels.height > 0 && pixels.width < 65'536 &&
                 pixels.height < 65'536 && quality >= 1 && quality <= 100);
  Component y{quanta_of(kLuminance, quality), codes_of(kLuminanceDc), codes_of(kLuminanceAc)};
  Component cb{quanta_of(kChrominance, quality), codes_of(kChrominanceDc),
               codes_of(kChrominanceAc)};
  Component cr = cb;
  std::string out = headers(pixels, y.quanta, cb.quanta);
  BitWriter bits(out);
  for (int top = 0; top < pixels.height; top += kCell) {
    for (int left = 0; left < pixels.width; left += kCell) {
      const Cell cell(pixels, left, top);
      for (const Block& block : cell.y) put_block(block, y, bits);
      put_block(cell.cb, cb, bits);
      put_block(cell.cr, cr, bits);
    }
  }
  bits.finish();
  return out + "\xFF\xD9";
}

}  // namespace vinerow::tools::report
