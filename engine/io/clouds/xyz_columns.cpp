#include "engine/io/clouds/xyz_columns.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "engine/io/clouds/point_cloud_scalar.h"

namespace vinerow::io {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<std::size_t> quantity_of(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::erase(lower, '"');
  const auto is = [&](std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), lower) != names.end();
  };
  if (is({"x", "x_m", "easting", "east", "e"})) return 0;
  if (is({"y", "y_m", "northing", "north", "n"})) return 1;
  if (is({"z", "z_m", "height", "elevation", "h"})) return 2;
  if (is({"red", "r"})) return 3;
  if (is({"green", "g"})) return 4;
  if (is({"blue", "b"})) return 5;
  if (is({"classification", "class", "label"})) return 6;
  return std::nullopt;
}

}  // namespace

char separator_of(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return ';';
  return line.find(',') != std::string_view::npos ? ',' : ' ';
}

std::optional<std::string_view> next_field(std::optional<std::string_view>* line, char separator) {
  if (!*line) return std::nullopt;
  if (separator == ' ') {
    const std::string_view word = next_word(&**line);
    return word.empty() ? std::nullopt : std::optional(word);
  }
  const std::size_t end = (*line)->find(separator);
  const std::string_view field = trimmed((*line)->substr(0, end));
  // Text after the last separator is a field only if it is not empty.
  const bool is_last = end == std::string_view::npos;
  const std::string_view rest = is_last ? std::string_view() : (*line)->substr(end + 1);
  *line = is_last || trimmed(rest).empty() ? std::nullopt : std::optional(rest);
  return field;
}

std::size_t count_fields(std::string_view line, char separator) {
  std::optional<std::string_view> rest = line;
  std::size_t count = 0;
  while (next_field(&rest, separator)) ++count;
  return count;
}

std::optional<XyzColumns> named_columns(std::string_view line) {
  XyzColumns columns;
  std::optional<std::string_view> rest = trimmed(line);
  while (rest->starts_with('#') || rest->starts_with('/')) rest->remove_prefix(1);
  const char separator = separator_of(*rest);
  while (const std::optional<std::string_view> name = next_field(&rest, separator)) {
    const std::optional<std::size_t> quantity = quantity_of(*name);
    if (quantity && !columns.of[*quantity]) columns.of[*quantity] = columns.count;
    ++columns.count;
  }
  return columns.of[0] && columns.of[1] && columns.of[2] ? std::optional(columns) : std::nullopt;
}

XyzColumns usual_columns(std::string_view line, char separator, bool is_pts) {
  XyzColumns columns;
  for (std::size_t k = 0; k < 3; ++k) columns.of[k] = k;
  const std::size_t colour_at = is_pts ? 4 : 3;
  std::optional<std::string_view> rest = line;
  std::size_t column = 0, whole = 0;
  while (const std::optional<std::string_view> field = next_field(&rest, separator)) {
    if (column >= colour_at && column < colour_at + 3) {
      const std::optional<std::uint64_t> value = parse_count(*field);
      if (value && *value <= 255) ++whole;
    }
    ++column;
  }
  if (whole == 3) {
    for (std::size_t k = 0; k < 3; ++k) columns.of[3 + k] = colour_at + k;
  }
  return columns;
}

}  // namespace vinerow::io
