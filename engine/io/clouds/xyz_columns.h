#pragma once
/// Columns of a text file of points, and splitting of its lines.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace vinerow::io {

/// Column of each quantity; nullopt if the file lacks it.
struct XyzColumns {
  std::array<std::optional<std::size_t>, 7> of;  ///< x y z red green blue classification
  std::size_t count = 0;                         ///< number of columns
  bool has_colour() const { return of[3] && of[4] && of[5]; }
};

/// ';' or ',' if the line contains one, else ' ' for any blanks.
char separator_of(std::string_view line);

/// Removes the next field from `line`, without surrounding blanks; nullopt after the last.
std::optional<std::string_view> next_field(std::optional<std::string_view>* line, char separator);

std::size_t count_fields(std::string_view line, char separator);

/// Columns from the names in a first line; nullopt if it does not name x, y and z.
std::optional<XyzColumns> named_columns(std::string_view line);

/// Columns of a file without names, from its first line of points.
/// @param is_pts  there is an intensity column before the colour
XyzColumns usual_columns(std::string_view line, char separator, bool is_pts);

}  // namespace vinerow::io
