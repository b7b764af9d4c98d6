#pragma once
/// Conversion of text of unknown origin to valid UTF-8.

#include <string>
#include <string_view>

namespace vinerow::io {

/// Code points of a text; each byte that is not UTF-8 becomes one U+FFFD.
std::u32string code_points_of(std::string_view text);

/// The text as UTF-8 with such bytes replaced.
std::string valid_utf8(std::string_view text);

}  // namespace vinerow::io
