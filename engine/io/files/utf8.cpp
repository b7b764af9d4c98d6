#include "engine/io/files/utf8.h"

#include <algorithm>
#include <cstdint>

namespace vinerow::io {
namespace {

constexpr char32_t kReplacement = 0xFFFD;

std::uint32_t byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
}

/// Removes one code point from the front. Accepts shortest forms only, no surrogates (RFC 3629).
char32_t take_code_point(std::string_view& text) {
  const std::uint32_t first = byte_at(text, 0);
  const int more = first < 0x80 ? 0 : first < 0xC2 ? -1 : first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
  char32_t point = more == 0 ? first : first & (0x3Fu >> std::max(more, 0));
  bool good = more >= 0 && first < 0xF5;
  for (int i = 1; good && i <= more; ++i) {
    const std::uint32_t next = byte_at(text, i);
    good = (next & 0xC0u) == 0x80u;
    point = point << 6 | (next & 0x3Fu);
  }
  good = good && !(more == 2 && point < 0x800) && !(more == 3 && point < 0x10000) &&
         !(point >= 0xD800 && point < 0xE000) && point < 0x110000;
  text.remove_prefix(good ? more + 1 : 1);
  return good ? point : kReplacement;
}

}  // namespace

std::u32string code_points_of(std::string_view text) {
  std::u32string points;
  while (!text.empty()) points += take_code_point(text);
  return points;
}

std::string valid_utf8(std::string_view text) {
  std::string valid;
  valid.reserve(text.size());
  while (!text.empty()) {
    const std::string_view rest = text;
    const char32_t point = take_code_point(text);
    const std::size_t length = rest.size() - text.size();
    const bool replaced = point == kReplacement && length == 1;
    valid += replaced ? std::string_view("\xEF\xBF\xBD") : rest.substr(0, length);
  }
  return valid;
}

}  // namespace vinerow::io
