#include "engine/io/grids/pgm.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/yaml.h"

namespace vinerow::io {
namespace {

constexpr std::int64_t kMaxPixels = 100'000'000;

/// Bytes as shown in errors: 'P6', '\x89PNG'.
std::string readable(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += byte >= 0x20 && byte < 0x7f ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
  }
  return "'" + text + "'";
}

/// Reader of the bytes of a PGM file.
class PgmReader {
 public:
  explicit PgmReader(const std::filesystem::path& file) : file_(file) {
    std::optional<std::string> bytes = read_bytes(file);
    if (!bytes) {
      throw ConfigError(
          fmt::format("image '{}' does not exist{}", file.string(), nearest_file_hint(file)));
    }
    bytes_ = std::move(*bytes);
  }

  /// "P5" or "P2".
  std::string magic() {
    const std::string kind = bytes_.substr(0, 2);
    if (kind != "P5" && kind != "P2") {
      fail(fmt::format("is not a PGM image: it begins with {}, must begin with P5 or P2",
                       readable(kind)));
    }
    at_ = 2;
    return kind;
  }

  /// The next whole number, after white space and comments (# to the end of the line).
  std::int64_t number(const char* what, std::int64_t min_value, std::int64_t max_value) {
    skip_blanks();
    if (at_ >= bytes_.size()) fail(fmt::format("ends before its {}", what));
    const std::size_t begin = at_;
    std::int64_t value = 0;
    while (at_ < bytes_.size() && is_digit(bytes_[at_])) {
      value = std::min<std::int64_t>(10 * value + (bytes_[at_++] - '0'), 1'000'000'000'000);
    }
    if (at_ == begin) {
      fail(fmt::format("has no whole number as its {}, but {}", what,
                       readable(bytes_.substr(begin, 8))));
    }
    if (value < min_value || value > max_value) {
      fail(fmt::format("has {} = {}, must be {} to {}", what, value, min_value, max_value));
    }
    return value;
  }

  std::int64_t size() const { return static_cast<std::int64_t>(bytes_.size()); }
  /// The bytes after the one white space that ends the header.
  std::string_view raw() const {
    return std::string_view(bytes_).substr(std::min(at_ + 1, bytes_.size()));
  }

  [[noreturn]] void fail(const std::string& sentence) const {
    throw ConfigError(fmt::format("'{}' {}", file_.string(), sentence));
  }

 private:
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  void skip_blanks() {
    for (; at_ < bytes_.size(); ++at_) {
      const char c = bytes_[at_];
      if (c == '#') {
        at_ = std::min(bytes_.find('\n', at_), bytes_.size() - 1);
      } else if (c != ' ' && (c < '\t' || c > '\r')) {
        return;
      }
    }
  }

  const std::filesystem::path& file_;
  std::string bytes_;
  std::size_t at_ = 0;
};

void read_binary(PgmReader& reader, GrayImage& image) {
  const std::string_view raw = reader.raw();
  const std::size_t depth = image.maximum > 255 ? 2 : 1;
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  if (raw.size() < pixels * depth) {
    reader.fail(fmt::format("is cut off: {} x {} pixels are {} bytes, it holds {}", image.width,
                            image.height, pixels * depth, raw.size()));
  }
  image.values.resize(pixels);
  const auto byte = [&](std::size_t k) { return static_cast<std::uint8_t>(raw[k]); };
  for (std::size_t k = 0; k < pixels; ++k) {
    const int value = depth == 1 ? byte(k) : 256 * byte(2 * k) + byte(2 * k + 1);
    if (value > image.maximum) {
      reader.fail(fmt::format("has a pixel of {}, must be at most {}", value, image.maximum));
    }
    image.values[k] = static_cast<std::uint16_t>(value);
  }
}

}  // namespace

GrayImage read_pgm(const std::filesystem::path& file) {
  constexpr int kMaxPerSide = 1'000'000;
  PgmReader reader(file);
  const std::string kind = reader.magic();
  GrayImage image;
  image.width = static_cast<int>(reader.number("width", 1, kMaxPerSide));
  image.height = static_cast<int>(reader.number("height", 1, kMaxPerSide));
  const std::int64_t pixels = std::int64_t{image.width} * image.height;
  if (pixels > kMaxPixels) {
    reader.fail(fmt::format("has {} x {} pixels, must be at most {} million", image.width,
                            image.height, kMaxPixels / 1'000'000));
  }
  image.maximum = static_cast<int>(reader.number("maximum", 1, 65535));
  if (kind == "P5") {
    read_binary(reader, image);
  } else {
    // A pixel takes at least a digit and a blank, so the file's size bounds the reserved memory.
    if (2 * pixels - 1 > reader.size()) {
      reader.fail(fmt::format("is cut off: {} x {} pixels do not fit into its {} bytes",
                              image.width, image.height, reader.size()));
    }
    image.values.resize(static_cast<std::size_t>(pixels));
    for (std::uint16_t& value : image.values) {
      value = static_cast<std::uint16_t>(reader.number("pixel", 0, image.maximum));
    }
  }
  return image;
}

void write_pgm(const std::filesystem::path& file, const GrayImage& image) {
  VINEROW_DEMAND(image.maximum <= 255);
  std::string bytes = fmt::format("P5\n{} {}\n{}\n", image.width, image.height, image.maximum);
  bytes.reserve(bytes.size() + image.values.size());
  for (const std::uint16_t value : image.values) bytes += static_cast<char>(value);
  write_whole_file(file, bytes);
}

}  // namespace vinerow::io
