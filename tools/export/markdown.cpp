#include "tools/export/markdown.h"

#include <algorithm>
#include <cctype>

namespace vinerow::tools {
namespace {

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

bool is_letter_or_digit(std::string_view text, std::size_t at) {
  return at < text.size() && std::isalnum(static_cast<unsigned char>(text[at])) != 0;
}

}  // namespace

std::string markdown_text(std::string_view text) {
  std::string escaped;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    // An underscore within a word needs no escape, so keys in descriptions stay legible.
    const bool in_word =
        c == '_' && i > 0 && is_letter_or_digit(text, i - 1) && is_letter_or_digit(text, i + 1);
    if (!in_word && std::string_view("\\`*_|<&[]~$").find(c) != std::string_view::npos) {
      escaped += '\\';
    }
    escaped += is_control(c) ? ' ' : c;
  }
  return escaped;
}

std::string markdown_code(std::string_view text) {
  if (text.empty()) return "";
  std::string content;
  std::size_t run = 0, longest = 0;
  for (const char c : text) {
    run = c == '`' ? run + 1 : 0;
    longest = std::max(longest, run);
    if (c == '|') content += '\\';
    content += is_control(c) ? ' ' : c;
  }
  // The fence is longer than any run of backticks inside; spaces separate it from backticks at the
  // ends.
  const std::string fence(longest + 1, '`');
  const char* space = longest > 0 ? " " : "";
  return fence + space + content + space + fence;
}

}  // namespace vinerow::tools
