#pragma once
/// Base64 encoding of bytes embedded in a page. Source: RFC 4648, "The Base16, Base32, and Base64
/// Data Encodings", section 4.

#include <string>
#include <string_view>

namespace vinerow::tools {

/// With padding, without line breaks.
std::string base64(std::string_view bytes);

}  // namespace vinerow::tools
