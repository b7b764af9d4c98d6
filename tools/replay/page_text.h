#pragma once
/// Text of HTML pages. All output is well-formed XML too.

#include <string>
#include <string_view>

namespace vinerow::tools {

/// Text for content and attributes. Escapes & < > ", drops control characters, and replaces invalid
/// UTF-8 bytes by U+FFFD.
std::string escaped(const std::string& text);

/// Start of a page, up to and including <body>. @param title  plain text @param style  CSS
std::string page_head(const std::string& title, std::string_view style);

/// Base64 encoding of embedded bytes, with padding and without line breaks. Source: RFC 4648, "The
/// Base16, Base32, and Base64 Data Encodings", section 4.
std::string base64(std::string_view bytes);

}  // namespace vinerow::tools
