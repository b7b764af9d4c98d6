#pragma once
/// Text of unknown origin as UTF-8.

#include <string>
#include <string_view>

namespace vinerow::tools {

/// The code points of a text; bytes that are no UTF-8 become U+FFFD, one for each.
std::u32string code_points_of(std::string_view text);

/// The text with those bytes replaced.
std::string valid_utf8(std::string_view text);

}  // namespace vinerow::tools
