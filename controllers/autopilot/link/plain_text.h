#pragma once
/// Texts from outside, for messages and events.

#include <algorithm>
#include <string>
#include <string_view>

namespace vinerow::controllers {

/// With '?' for what is no printable ASCII: line ends, control characters of terminals, bytes.
inline std::string plain_text(std::string_view text) {
  std::string plain(text);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return plain;
}

}  // namespace vinerow::controllers
