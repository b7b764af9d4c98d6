#include "engine/io/clouds/ply_header.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace vinerow::io {
namespace {

constexpr std::uint64_t kMaxLines = 10'000;
constexpr std::uint64_t kMaxBytes = 1 << 20;
constexpr std::size_t kMaxProperties = 1'000;
constexpr std::size_t kMaxComments = 100;

Scalar parse_type(const BlockFile& file, std::string_view word) {
  constexpr std::array<std::pair<std::string_view, Scalar>, 16> kTypes = {{
      {"char", Scalar::kI8},
      {"uchar", Scalar::kU8},
      {"short", Scalar::kI16},
      {"ushort", Scalar::kU16},
      {"int", Scalar::kI32},
      {"uint", Scalar::kU32},
      {"float", Scalar::kF32},
      {"double", Scalar::kF64},
      {"int8", Scalar::kI8},
      {"uint8", Scalar::kU8},
      {"int16", Scalar::kI16},
      {"uint16", Scalar::kU16},
      {"int32", Scalar::kI32},
      {"uint32", Scalar::kU32},
      {"float32", Scalar::kF32},
      {"float64", Scalar::kF64},
  }};
  for (const auto& [name, type] : kTypes) {
    if (name == word) return type;
  }
  file.fail(fmt::format("has the unknown type '{}' in line {}", word, file.line_number()));
}

void read_format(const BlockFile& file, std::string_view line, PlyHeader& header) {
  const std::string_view format = next_word(&line);
  const std::string_view version = next_word(&line);
  header.ascii = format == "ascii";
  header.order = format == "binary_big_endian" ? std::endian::big : std::endian::little;
  if (!header.ascii && format != "binary_little_endian" && format != "binary_big_endian") {
    file.fail(
        fmt::format("has the format '{}', must be ascii, binary_little_endian or "
                    "binary_big_endian",
                    format));
  }
  if (version != "1.0") file.fail(fmt::format("is PLY '{}', must be 1.0", version));
}

void read_element(const BlockFile& file, std::string_view line, PlyHeader& header) {
  PlyElement element;
  element.name = next_word(&line);
  const std::string_view count = next_word(&line);
  const std::optional<std::uint64_t> number = parse_count(count);
  if (!number) {
    file.fail(fmt::format("has '{}' as the count of the element '{}', must be a whole number >= 0",
                          count, element.name));
  }
  element.count = *number;
  if (header.elements.size() >= kMaxProperties) file.fail("has too many elements");
  header.elements.push_back(std::move(element));
}

void read_property(const BlockFile& file, std::string_view line, PlyHeader& header) {
  if (header.elements.empty()) {
    file.fail(
        fmt::format("has a property before the first element in line {}", file.line_number()));
  }
  PlyProperty property;
  std::string_view type = next_word(&line);
  if (type == "list") {
    property.list_count_type = parse_type(file, next_word(&line));
    if (is_real(*property.list_count_type)) {
      file.fail(fmt::format("has a list counted by real numbers in line {}", file.line_number()));
    }
    type = next_word(&line);
  }
  property.type = parse_type(file, type);
  property.name = next_word(&line);
  if (property.name.empty()) {
    file.fail(fmt::format("has a property without name in line {}", file.line_number()));
  }
  std::vector<PlyProperty>& properties = header.elements.back().properties;
  if (properties.size() >= kMaxProperties) {
    file.fail(fmt::format("has more than {} properties in the element '{}'", kMaxProperties,
                          header.elements.back().name));
  }
  properties.push_back(std::move(property));
}

}  // namespace

bool PlyElement::has_lists() const {
  for (const PlyProperty& property : properties) {
    if (property.list_count_type) return true;
  }
  return false;
}

std::size_t PlyElement::fixed_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties) {
    if (!property.list_count_type) bytes += size_of(property.type);
  }
  return bytes;
}

PlyHeader read_ply_header(BlockFile& file) {
  PlyHeader header;
  bool has_format = false;
  std::string_view line;
  file.line(&line);  // "ply"
  while (file.line(&line)) {
    if (file.line_number() > kMaxLines || file.position() > kMaxBytes) {
      file.fail(fmt::format("has no PLY header: no end_header within {} lines and {} bytes",
                            kMaxLines, kMaxBytes));
    }
    const std::string_view keyword = next_word(&line);
    if (keyword == "end_header") {
      if (!has_format) file.fail("has no line 'format' in its header");
      return header;
    }
    if (keyword == "format") {
      read_format(file, line, header);
      has_format = true;
    } else if (keyword == "element") {
      read_element(file, line, header);
    } else if (keyword == "property") {
      read_property(file, line, header);
    } else if (keyword == "comment") {
      if (header.comments.size() < kMaxComments) header.comments.emplace_back(line);
    } else if (keyword != "obj_info" && !keyword.empty()) {
      file.fail(fmt::format("has the unknown word '{}' in line {} of its header",
                            keyword.substr(0, 40), file.line_number()));
    }
  }
  file.fail("is cut off: its header has no end_header");
}

}  // namespace vinerow::io
