#pragma once
/// Which column of a text file means what, and how a line is split.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace vinerow::io {

/// Column of each quantity; nullopt where the file has none.
struct XyzColumns {
  std::array<std::optional<std::size_t>, 7> of;  ///< x y z red green blue classification
  std::size_t count = 0;                         ///< names there are
  bool has_colour() const { return of[3] && of[4] && of[5]; }
};

/// ';' or ',' where the line has one, else ' ' for any blanks.
char separator_of(std::string_view line);

/// The next field of a line, without blanks around it; nullopt after the last. `line` loses it.
std::optional<std::string_view> next_field(std::optional<std::string_view>* line, char separator);

std::size_t count_fields(std::string_view line, char separator);

/// The columns by the names in a first line; nullopt where it does not name x, y and z.
std::optional<XyzColumns> named_columns(std::string_view line);

/// The columns of a file without names, by its first line of points.
/// @param is_pts  an intensity lies before the colour
XyzColumns usual_columns(std::string_view line, char separator, bool is_pts);

}  // namespace vinerow::io
