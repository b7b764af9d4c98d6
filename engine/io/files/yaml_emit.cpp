#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "engine/io/files/yaml.h"

namespace vinerow::io {
namespace {

/// Words that YAML 1.1 readers interpret as booleans or nulls.
constexpr std::array<std::string_view, 10> kReservedWords = {"true", "false", "null", "yes", "no",
                                                             "on",   "off",   "y",    "n",   "nan"};

bool needs_no_quotes(const std::string& text) {
  if (text.empty() || text.size() > 80) return false;
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  if (!letter(text[0]) && text[0] != '_' && text[0] != '/') return false;
  if (!std::all_of(text.begin(), text.end(), [&](char c) {
        return letter(c) || digit(c) || c == '_' || c == '.' || c == '/' || c == '-' || c == '+';
      })) {
    return false;
  }
  std::string lower = text;
  for (char& c : lower) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return std::find(kReservedWords.begin(), kReservedWords.end(), lower) == kReservedWords.end();
}

std::string quoted(const std::string& text) {
  if (needs_no_quotes(text)) return text;
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      result += fmt::format("\\x{:02x}", byte);
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string in_one_line(const YamlNode& node) {
  std::string result;
  switch (node.kind) {
    case YamlKind::kNull:
      return "null";
    case YamlKind::kScalar:
      return node.quoted || std::holds_alternative<std::string>(scalar_value(node))
                 ? quoted(node.text)
                 : node.text;
    case YamlKind::kList:
      for (const YamlNode& item : node.items) {
        result += (result.empty() ? "" : ", ") + in_one_line(item);
      }
      return "[" + result + "]";
    case YamlKind::kMapping:
      for (const YamlEntry& entry : node.entries) {
        result +=
            (result.empty() ? "" : ", ") + quoted(entry.key) + ": " + in_one_line(entry.value);
      }
      return "{" + result + "}";
  }
  return result;
}

bool fits_one_line(const YamlNode& node) {
  if (node.flow || node.is_scalar() || node.is_null()) return true;
  if (node.is_mapping()) return node.entries.empty();
  return std::all_of(node.items.begin(), node.items.end(),
                     [](const YamlNode& item) { return fits_one_line(item); });
}

void emit_block(const YamlNode& node, int indent, std::string& out);

/// Prints the value after "key:" or "-": in the same line, or as a block below.
void emit_value(const YamlNode& node, int indent, std::string& out) {
  if (fits_one_line(node)) {
    out += " " + in_one_line(node) + "\n";
  } else {
    out += "\n";
    emit_block(node, indent, out);
  }
}

void emit_block(const YamlNode& node, int indent, std::string& out) {
  const std::string spaces(static_cast<std::size_t>(indent), ' ');
  for (const YamlEntry& entry : node.entries) {
    out += spaces + quoted(entry.key) + ":";
    emit_value(entry.value, indent + 2, out);
  }
  for (const YamlNode& item : node.items) {
    if (fits_one_line(item)) {
      out += spaces + "- " + in_one_line(item) + "\n";
      continue;
    }
    // A block starts on the line of its dash: "- metric: ...".
    std::string block;
    emit_block(item, indent + 2, block);
    block[static_cast<std::size_t>(indent)] = '-';
    out += block;
  }
}

}  // namespace

std::string to_yaml(const YamlNode& node) {
  if (fits_one_line(node)) return in_one_line(node) + "\n";
  std::string out;
  emit_block(node, 0, out);
  return out;
}

}  // namespace vinerow::io
