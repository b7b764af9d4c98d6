#include "engine/io/files/yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/io/files/placed_error.h"

namespace vinerow::io {

std::string SourceMark::text() const {
  return line > 0 ? fmt::format("{}:{}", file, line) : file;
}

const YamlEntry* YamlNode::find_entry(std::string_view key) const {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

const YamlNode* YamlNode::find(std::string_view key) const {
  const YamlEntry* entry = find_entry(key);
  return entry ? &entry->value : nullptr;
}

YamlNode* YamlNode::find(std::string_view key) {
  return const_cast<YamlNode*>(std::as_const(*this).find(key));
}

void YamlNode::put(std::string key, YamlNode value) {
  if (YamlNode* existing = find(key)) {
    *existing = std::move(value);
    return;
  }
  const SourceMark key_mark = value.mark;
  entries.push_back({std::move(key), key_mark, std::move(value)});
}

void YamlNode::erase(std::string_view key) {
  std::erase_if(entries, [&](const auto& e) { return e.key == key; });
}

YamlNode yaml_mapping() {
  YamlNode node;
  node.kind = YamlKind::kMapping;
  return node;
}

YamlNode yaml_list() {
  YamlNode node;
  node.kind = YamlKind::kList;
  return node;
}

YamlNode yaml_text(std::string text) {
  YamlNode node;
  node.kind = YamlKind::kScalar;
  node.text = std::move(text);
  node.quoted = true;
  return node;
}

namespace {

YamlNode plain(std::string text) {
  YamlNode node = yaml_text(std::move(text));
  node.quoted = false;
  return node;
}

bool is_digits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// [-+]? ( \. [0-9]+ | [0-9]+ ( \. [0-9]* )? ) ( [eE] [-+]? [0-9]+ )?   (YAML 1.2, section 10.3.2)
bool looks_like_number(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  const std::size_t e = text.find_first_of("eE");
  if (e != std::string_view::npos) {
    std::string_view exponent = text.substr(e + 1);
    if (!exponent.empty() && (exponent[0] == '-' || exponent[0] == '+')) exponent.remove_prefix(1);
    if (!is_digits(exponent)) return false;
    text = text.substr(0, e);
  }
  const std::size_t point = text.find('.');
  if (point == std::string_view::npos) return is_digits(text);
  const std::string_view whole = text.substr(0, point), fraction = text.substr(point + 1);
  if (whole.empty()) return is_digits(fraction);
  return is_digits(whole) && (fraction.empty() || is_digits(fraction));
}

/// @pre looks_like_number(text). Overflow gives an infinity, underflow a zero.
double parse_yaml_number(std::string_view text) {
  const bool negative = text[0] == '-';
  if (text[0] == '-' || text[0] == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec == std::errc::result_out_of_range) {
    // from_chars does not distinguish overflow from underflow; the exponent's sign or the whole
    // part does.
    const std::size_t e = text.find_first_of("eE");
    const bool tiny =
        e != std::string_view::npos
            ? text[e + 1] == '-'
            : text.substr(0, text.find('.')).find_first_of("123456789") == std::string_view::npos;
    value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
  }
  return negative ? -value : value;
}

}  // namespace

YamlNode yaml_number(double value) {
  return plain(fmt::format("{}", value));
}
YamlNode yaml_integer(std::int64_t value) {
  return plain(fmt::format("{}", value));
}
YamlNode yaml_boolean(bool value) {
  return plain(value ? "true" : "false");
}

YamlScalar scalar_value(const YamlNode& scalar) {
  const std::string& text = scalar.text;
  if (scalar.quoted || text.empty()) return text;
  if (text == "true" || text == "True" || text == "TRUE") return true;
  if (text == "false" || text == "False" || text == "FALSE") return false;
  if (text == ".nan" || text == ".NaN" || text == ".NAN") {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const std::string_view unsigned_text =
      text[0] == '-' || text[0] == '+' ? std::string_view(text).substr(1) : text;
  if (unsigned_text == ".inf" || unsigned_text == ".Inf" || unsigned_text == ".INF") {
    const double infinity = std::numeric_limits<double>::infinity();
    return text[0] == '-' ? -infinity : infinity;
  }
  const char* end = text.data() + text.size();
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'o')) {
    std::int64_t value = 0;
    const auto result = std::from_chars(text.data() + 2, end, value, text[1] == 'x' ? 16 : 8);
    if (result.ec == std::errc() && result.ptr == end && text[2] != '-') return value;
    return text;
  }
  if (!looks_like_number(text)) return text;
  if (is_digits(unsigned_text)) {
    std::int64_t value = 0;
    const char* begin = text[0] == '+' ? text.data() + 1 : text.data();
    if (std::from_chars(begin, end, value).ec == std::errc()) return value;
  }
  return parse_yaml_number(text);
}

void fail_at(const SourceMark& mark, const std::string& sentence) {
  const std::string place = mark.text();
  std::string one_line;
  for (const char c : place.empty() ? sentence : place + ": " + sentence) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n') {
      one_line += "\\n";
    } else if (byte < 0x20 || byte == 0x7f) {
      one_line += fmt::format("\\x{:02x}", byte);
    } else {
      one_line += c;
    }
  }
  throw PlacedError(mark, leading_key(sentence), one_line);
}

std::string leading_key(const std::string& sentence) {
  const std::size_t end = sentence.find_first_not_of(
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.[]");
  if (end == 0 || end == std::string::npos) return "";
  const std::string_view rest = std::string_view(sentence).substr(end);
  const bool is_key =
      rest.starts_with(" = ") || rest.starts_with(": ") || rest.starts_with(" must ");
  return is_key ? sentence.substr(0, end) : "";
}

std::string shown(const YamlNode& node) {
  switch (node.kind) {
    case YamlKind::kNull:
      return "nothing";
    case YamlKind::kList:
      return "a list";
    case YamlKind::kMapping:
      return "a mapping";
    case YamlKind::kScalar:
      break;
  }
  const bool is_text = std::holds_alternative<std::string>(scalar_value(node));
  std::string text = node.text;
  if (text.size() > 60) {
    // Cut between characters, not inside one (UTF-8 continuation bytes are 10xxxxxx).
    std::size_t end = 60;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    text = text.substr(0, end) + "...";
  }
  return is_text ? "'" + text + "'" : text;
}

std::string nearest_file_hint(const std::filesystem::path& missing) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator it(missing.parent_path(), error), end;
       !error && it != end; it.increment(error)) {
    names.push_back(it->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return did_you_mean(missing.filename().string(), names);
}

}  // namespace vinerow::io
