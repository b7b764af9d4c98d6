#include "tools/study/plots/text_fit.h"

#include <algorithm>
#include <string_view>

#include "engine/io/files/utf8.h"

namespace vinerow::study {
namespace {

/// Width of a letter relative to the font size: groups of Helvetica's widths, rounded up.
double letter_width(char32_t letter) {
  constexpr std::u32string_view kNarrow = U"fijlrtI.,:;'!|()[]/\\ -";
  constexpr std::u32string_view kWide = U"mwMW%@…−—";
  if (kNarrow.find(letter) != std::u32string_view::npos) return 0.36;
  if (kWide.find(letter) != std::u32string_view::npos) return 1.0;
  if (letter >= U'A' && letter <= U'Z') return 0.76;
  // From here on, scripts with square letters.
  if (letter >= 0x1100) return letter < 0x2E80 && letter >= 0x2000 ? 0.7 : 1.05;
  return 0.59;
}

double width_of(std::u32string_view letters, double size_px) {
  double width = 0.0;
  for (const char32_t letter : letters) width += letter_width(letter);
  return width * size_px;
}

void append_utf8(char32_t letter, std::string& out) {
  const auto byte = [&](char32_t bits) { out += static_cast<char>(bits); };
  if (letter < 0x80) {
    byte(letter);
  } else if (letter < 0x800) {
    byte(0xC0 | letter >> 6), byte(0x80 | (letter & 0x3F));
  } else if (letter < 0x10000) {
    byte(0xE0 | letter >> 12), byte(0x80 | (letter >> 6 & 0x3F)), byte(0x80 | (letter & 0x3F));
  } else {
    byte(0xF0 | letter >> 18), byte(0x80 | (letter >> 12 & 0x3F));
    byte(0x80 | (letter >> 6 & 0x3F)), byte(0x80 | (letter & 0x3F));
  }
}

}  // namespace

double widest_px(const std::string& text, double size_px) {
  return width_of(io::code_points_of(text), size_px);
}

std::string shortened(const std::string& text, double width_px, double size_px) {
  const std::u32string letters = io::code_points_of(text);
  if (width_of(letters, size_px) <= width_px) return text;
  std::string out;
  double used = letter_width(U'…') * size_px;
  for (const char32_t letter : letters) {
    used += letter_width(letter) * size_px;
    if (used > width_px) break;
    append_utf8(letter, out);
  }
  // No space before the dots.
  out.erase(out.find_last_not_of(' ') + 1);
  return out.empty() ? "" : out + "…";
}

std::vector<std::string> wrapped(const std::string& text, double width_px, double size_px,
                                 std::size_t max_lines) {
  std::vector<std::string> lines;
  std::string_view rest = text;
  while (!rest.empty()) {
    if (lines.size() + 1 == max_lines) {
      lines.push_back(shortened(std::string(rest), width_px, size_px));
      return lines;
    }
    // As many words as fit, but at least one.
    std::size_t end = std::min(rest.find(' '), rest.size());
    while (end < rest.size()) {
      const std::size_t next = std::min(rest.find(' ', end + 1), rest.size());
      if (widest_px(std::string(rest.substr(0, next)), size_px) > width_px) break;
      end = next;
    }
    lines.push_back(shortened(std::string(rest.substr(0, end)), width_px, size_px));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return lines;
}

}  // namespace vinerow::study
