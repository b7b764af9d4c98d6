#pragma once
/// Cells of CSV tables.

#include <string>
#include <string_view>

namespace vinerow::io {

/// A text by RFC 4180: quoted if it contains a comma, a quote or a line end, with quotes doubled.
std::string csv_text(std::string_view text);

/// A number that is read back as the same double; empty for NaN.
std::string csv_number(double value);

}  // namespace vinerow::io
