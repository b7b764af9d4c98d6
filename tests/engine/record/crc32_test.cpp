#include "engine/record/crc32.h"

#include <gtest/gtest.h>

#include <span>
#include <string_view>
#include <vector>

namespace vinerow::record::crc32_test {
namespace {

std::uint32_t crc_of(std::string_view text) {
  return calc_crc32({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

// The check value of every CRC-32 catalogue, and RFC 3720-style patterns computed with Python.
TEST(Crc32, AgreesWithTheCheckValue) {
  EXPECT_EQ(crc_of("123456789"), 0xCBF43926u);
}

TEST(Crc32, AgreesWithKnownValues) {
  EXPECT_EQ(crc_of(""), 0u);
  EXPECT_EQ(crc_of("a"), 0xE8B7BE43u);
  EXPECT_EQ(crc_of("The quick brown fox jumps over the lazy dog"), 0x414FA339u);
  EXPECT_EQ(crc_of(std::string_view("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 16)), 0xECBB4B55u);
}

TEST(Crc32, PiecesGiveTheSameAsTheWhole) {
  std::vector<std::uint8_t> bytes(1000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 37);
  const std::uint32_t whole = calc_crc32(bytes);
  const std::span<const std::uint8_t> all(bytes);
  for (const std::size_t cut : {0, 1, 7, 8, 9, 500, 999, 1000}) {
    EXPECT_EQ(calc_crc32(all.subspan(cut), calc_crc32(all.first(cut))), whole);
  }
}

}  // namespace
}  // namespace vinerow::record::crc32_test
