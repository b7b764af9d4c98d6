#pragma once
/// Escaping of foreign texts in Markdown: no text opens a cell, a code span or an element.

#include <string>
#include <string_view>

namespace vinerow::tools {

/// Plain text on one line, fit for a table cell.
std::string markdown_text(std::string_view text);

/// Code span on one line, fit for a table cell. "" stays empty.
std::string markdown_code(std::string_view text);

}  // namespace vinerow::tools
