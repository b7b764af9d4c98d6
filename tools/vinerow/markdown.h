#pragma once
/// Texts of others in Markdown, so that none of them opens a cell, a code span or an element.

#include <string>
#include <string_view>

namespace vinerow::tools {

/// A text as it reads, on one line; fit for a cell of a table.
std::string markdown_text(std::string_view text);

/// A code span, on one line; fit for a cell of a table. "" stays empty.
std::string markdown_code(std::string_view text);

}  // namespace vinerow::tools
