#include "engine/io/clouds/pcd_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace vinerow::io {
namespace {

using Lines = std::map<std::string, std::vector<std::string>, std::less<>>;

/// Reads the lines of the header up to DATA, by their first word.
Lines read_lines(BlockFile& file) {
  constexpr std::uint64_t kMaxLines = 1'000;
  constexpr std::size_t kLongestLine = 10'000;
  constexpr std::array<std::string_view, 11> kKnown = {"VERSION",   "FIELDS", "COLUMNS", "SIZE",
                                                       "TYPE",      "COUNT",  "WIDTH",   "HEIGHT",
                                                       "VIEWPOINT", "POINTS", "DATA"};
  Lines lines;
  std::string_view line;
  while (file.line(&line)) {
    if (file.line_number() > kMaxLines || line.size() > kLongestLine) {
      file.fail(fmt::format("has no PCD header: no DATA within {} lines of at most {} bytes",
                            kMaxLines, kLongestLine));
    }
    const std::string key(next_word(&line));
    if (key.empty() || key.starts_with('#')) continue;
    if (std::find(kKnown.begin(), kKnown.end(), key) == kKnown.end()) {
      file.fail(fmt::format("has the unknown word '{}' in line {} of its header", key.substr(0, 40),
                            file.line_number()));
    }
    std::vector<std::string>& words = lines[key == "COLUMNS" ? "FIELDS" : key];
    words.clear();
    for (std::string_view word; !(word = next_word(&line)).empty();) words.emplace_back(word);
    if (key == "DATA") return lines;
  }
  file.fail("is cut off: its header has no line DATA");
}

const std::vector<std::string>& demand(const BlockFile& file, const Lines& lines,
                                       const std::string& key) {
  const auto found = lines.find(key);
  if (found == lines.end() || found->second.empty()) {
    file.fail(fmt::format("has no {} in its header", key));
  }
  return found->second;
}

std::uint64_t number(const BlockFile& file, const std::string& key, const std::string& word) {
  const std::optional<std::uint64_t> value = parse_count(word);
  if (!value) {
    file.fail(fmt::format("has {} = '{}', must be a whole number >= 0", key, word.substr(0, 40)));
  }
  return *value;
}

Scalar scalar_of(const BlockFile& file, const std::string& type, const std::string& size) {
  const std::string both = type + size;
  if (both == "I1") return Scalar::kI8;
  if (both == "U1") return Scalar::kU8;
  if (both == "I2") return Scalar::kI16;
  if (both == "U2") return Scalar::kU16;
  if (both == "I4") return Scalar::kI32;
  if (both == "U4") return Scalar::kU32;
  if (both == "I8") return Scalar::kI64;
  if (both == "U8") return Scalar::kU64;
  if (both == "F4") return Scalar::kF32;
  if (both == "F8") return Scalar::kF64;
  file.fail(
      fmt::format("has a field of TYPE {} and SIZE {}, must be I or U with 1, 2, 4, 8 or F "
                  "with 4, 8",
                  type.substr(0, 40), size.substr(0, 40)));
}

void read_pcd_fields(const BlockFile& file, const Lines& lines, PcdHeader& header) {
  const std::vector<std::string>& names = demand(file, lines, "FIELDS");
  const std::vector<std::string>& sizes = demand(file, lines, "SIZE");
  const std::vector<std::string>& types = demand(file, lines, "TYPE");
  const auto entry = lines.find("COUNT");
  const std::vector<std::string> counts =
      entry == lines.end() ? std::vector<std::string>(names.size(), "1") : entry->second;
  const auto check = [&](const char* key, std::size_t words) {
    if (words != names.size()) {
      file.fail(fmt::format("has {} FIELDS but {} words after {}", names.size(), words, key));
    }
  };
  check("SIZE", sizes.size());
  check("TYPE", types.size());
  check("COUNT", counts.size());
  for (std::size_t k = 0; k < names.size(); ++k) {
    PcdField field;
    field.name = names[k];
    field.type = scalar_of(file, types[k], sizes[k]);
    const std::uint64_t count = number(file, "COUNT", counts[k]);
    field.at = header.point_bytes;
    if (count > BlockFile::kBytes) {
      file.fail(fmt::format("has COUNT = {}, must be at most {}", count, BlockFile::kBytes));
    }
    field.count = static_cast<std::size_t>(count);
    header.point_bytes += field.count * size_of(field.type);
    if (header.point_bytes > BlockFile::kBytes) {
      file.fail(fmt::format("has points of more than {} bytes", BlockFile::kBytes));
    }
    header.fields.push_back(std::move(field));
  }
}

void read_pcd_count(const BlockFile& file, const Lines& lines, PcdHeader& header) {
  const std::uint64_t width = number(file, "WIDTH", demand(file, lines, "WIDTH").front());
  const std::uint64_t height = number(file, "HEIGHT", demand(file, lines, "HEIGHT").front());
  // Chosen: beyond any real cloud; the product of two such numbers fits into 64 bits.
  constexpr std::uint64_t kMax = std::uint64_t{1} << 31;
  if (width > kMax || height > kMax) {
    file.fail(fmt::format("has WIDTH {} and HEIGHT {}, must be at most {}", width, height, kMax));
  }
  header.points = width * height;
  const auto entry = lines.find("POINTS");
  if (entry == lines.end() || entry->second.empty()) return;
  const std::uint64_t points = number(file, "POINTS", entry->second.front());
  if (points != header.points) {
    file.fail(fmt::format("has POINTS {}, but WIDTH {} and HEIGHT {}", points, width, height));
  }
}

}  // namespace

PcdHeader read_pcd_header(BlockFile& file) {
  PcdHeader header;
  const Lines lines = read_lines(file);
  const std::string& data = demand(file, lines, "DATA").front();
  if (data == "binary_compressed") {
    file.fail(
        "is compressed (DATA binary_compressed), which is not supported; decompress it first, "
        "with 'pcl_convert_pcd_ascii_binary in.pcd out.pcd 1'");
  }
  if (data != "ascii" && data != "binary") {
    file.fail(fmt::format("has DATA {}, must be ascii or binary", data.substr(0, 40)));
  }
  header.ascii = data == "ascii";
  read_pcd_fields(file, lines, header);
  read_pcd_count(file, lines, header);
  return header;
}

}  // namespace vinerow::io
