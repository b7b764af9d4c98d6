#pragma once
/// Cells of comma-separated tables.

#include <string>
#include <string_view>

namespace vinerow::io {

/// A text as RFC 4180 has it: in quotes where it holds a comma, a quote or a line end, quotes
/// doubled.
std::string csv_text(std::string_view text);

/// A number that reads back as the same double; nothing for NaN.
std::string csv_number(double value);

}  // namespace vinerow::io
