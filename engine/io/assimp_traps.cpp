#include "engine/io/assimp_traps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "engine/core/error.h"

namespace Assimp {

/// Stands before assimp's own function of this name, which prints and aborts. ReadFile turns the
/// exception into its error text.
[[noreturn]] void aiAssertViolation(const char* condition, const char* /*file*/, int /*line*/) {
  throw std::runtime_error(std::string("its contents break a rule of the format (") + condition +
                           ")");
}

}  // namespace Assimp

namespace vinerow::io {
namespace {

/// Bytes of a scalar PLY type, 0 for an unknown one.
std::size_t size_of_type(const std::string& type) {
  static const std::map<std::string, std::size_t> kSizes = {
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = kSizes.find(type);
  return found == kSizes.end() ? 0 : found->second;
}

struct Property {
  std::size_t count_size;  // 0: a scalar
  std::size_t value_size;
  bool is_index;
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;

  bool all_scalar() const {
    return std::all_of(properties.begin(), properties.end(),
                       [](const Property& p) { return p.count_size == 0; });
  }
  std::size_t stride() const {
    std::size_t bytes = 0;
    for (const Property& p : properties) bytes += p.value_size;
    return bytes;
  }
};

struct TrapHeader {
  std::vector<Element> elements;
  std::vector<std::string> lines;  // without line ends
  bool big_endian = false;
};

/// @returns nullopt for ASCII files and for headers this reader does not understand
std::optional<TrapHeader> read_header(std::istream& stream) {
  TrapHeader header;
  constexpr std::size_t kMostLines = 10000;
  for (std::string line; std::getline(stream, line) && header.lines.size() < kMostLines;) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (header.lines.empty() && line != "ply") return std::nullopt;
    header.lines.push_back(line);
    std::istringstream words(line);
    std::string first, second, third, fourth;
    words >> first >> second >> third >> fourth;
    if (first == "format") {
      if (second.rfind("binary", 0) != 0) return std::nullopt;
      header.big_endian = second == "binary_big_endian";
    } else if (first == "element") {
      std::istringstream number(third);
      Element element;
      element.name = second;
      if (!(number >> element.count)) return std::nullopt;
      header.elements.push_back(element);
    } else if (first == "property") {
      if (header.elements.empty()) return std::nullopt;
      Property property{0, size_of_type(second), false};
      if (second == "list") {
        property = {size_of_type(third), size_of_type(fourth), true};
        if (property.count_size == 0 || property.count_size > 4) return std::nullopt;
      }
      if (property.value_size == 0) return std::nullopt;
      header.elements.back().properties.push_back(property);
    } else if (first == "end_header") {
      return header;
    }
  }
  return std::nullopt;
}

bool has_header_end(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  constexpr int kMostLines = 10000;
  std::string line;
  for (int i = 0; i < kMostLines && std::getline(stream, line); ++i) {
    if (line.rfind("end_header", 0) == 0) return true;
  }
  return false;
}

std::uint64_t read_unsigned(const char* bytes, std::size_t size, bool big_endian) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[big_endian ? i : size - 1 - i]);
    value = value << 8 | byte;
  }
  return value;
}

/// Walks over the data as the header describes it.
void check_data(const TrapHeader& header, const std::string& data,
                const std::filesystem::path& file) {
  std::size_t at = 0, vertices = 0;
  for (const Element& element : header.elements) {
    if (element.name == "vertex") vertices = element.count;
    for (std::size_t i = 0; i < element.count; ++i) {
      const auto need = [&](std::size_t bytes) {
        if (bytes > data.size() - at) {
          throw ConfigError(
              fmt::format("mesh file '{}' is cut off: element {} {} of {} is not whole",
                          file.string(), element.name, i + 1, element.count));
        }
      };
      for (const Property& property : element.properties) {
        std::size_t values = 1;
        if (property.count_size > 0) {
          need(property.count_size);
          values = read_unsigned(data.data() + at, property.count_size, header.big_endian);
          at += property.count_size;
        }
        need(values * property.value_size);
        if (element.name == "face" && property.is_index && property.value_size == 4 &&
            vertices > 0 && &property == &element.properties.front()) {
          for (std::size_t k = 0; k < values; ++k) {
            const auto index = read_unsigned(data.data() + at + 4 * k, 4, header.big_endian);
            if (index >= vertices) {
              throw ConfigError(
                  fmt::format("mesh file '{}': face {} names vertex {}, it has {} (0 to {})",
                              file.string(), i + 1, index, vertices, vertices - 1));
            }
          }
        }
        at += values * property.value_size;
      }
    }
  }
}

/// The same file with a byte before each vertex. @pre the first element is scalar
std::string add_guard(const TrapHeader& header, const std::string& data) {
  std::string content;
  int elements = 0;
  for (const std::string& line : header.lines) {
    content += line + "\n";
    if (line.rfind("element", 0) == 0 && ++elements == 1) content += "property uchar guard\n";
  }
  const Element& first = header.elements.front();
  const std::size_t stride = first.stride();
  content.reserve(content.size() + data.size() + first.count);
  for (std::size_t i = 0; i < first.count; ++i) {
    content += '\xff';
    content.append(data, i * stride, stride);
  }
  content.append(data, first.count * stride, std::string::npos);
  return content;
}

}  // namespace

std::optional<std::string> check_ply(const std::filesystem::path& file) {
  if (!has_header_end(file)) {
    throw ConfigError(fmt::format(
        "mesh file '{}' is cut off or no PLY: its header has no 'end_header'", file.string()));
  }
  std::ifstream stream(file, std::ios::binary);
  const std::optional<TrapHeader> header = read_header(stream);
  if (!header || header->elements.empty()) return std::nullopt;
  const std::string data((std::istreambuf_iterator<char>(stream)),
                         std::istreambuf_iterator<char>());
  check_data(*header, data, file);
  const bool mistaken = !data.empty() && (data[0] == '\n' || data[0] == '\r');
  if (!mistaken || !header->elements.front().all_scalar()) return std::nullopt;
  return add_guard(*header, data);
}

}  // namespace vinerow::io
