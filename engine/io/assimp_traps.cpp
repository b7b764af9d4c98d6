#include "engine/io/assimp_traps.h"

#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>

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

/// A binary PLY header whose first element is `vertex` with scalar properties alone.
struct PlyHeader {
  std::string text;  ///< with the guard property, LF line ends
  std::size_t vertices = 0;
  std::size_t stride = 0;  ///< bytes per vertex in the file
};

std::optional<PlyHeader> read_header(std::istream& stream) {
  PlyHeader header;
  int elements = 0;
  bool binary = false;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (header.text.empty() && line != "ply") return std::nullopt;
    header.text += line + "\n";
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    if (first == "format") binary = second.rfind("binary", 0) == 0;
    if (first == "element") {
      if (++elements == 1) {
        if (!binary || second != "vertex" || !(words >> header.vertices)) return std::nullopt;
        header.text += "property uchar guard\n";
      }
    } else if (first == "property" && elements == 1) {
      const std::size_t size = size_of_type(second);
      if (size == 0) return std::nullopt;
      header.stride += size;
    } else if (first == "end_header") {
      return elements > 0 ? std::optional(std::move(header)) : std::nullopt;
    }
    constexpr std::size_t kLongestHeader = 1 << 20;
    if (header.text.size() > kLongestHeader) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> read_guarded_ply(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::optional<PlyHeader> header = read_header(stream);
  if (!header) return std::nullopt;
  const int first_byte = stream.peek();
  if (first_byte != '\n' && first_byte != '\r') return std::nullopt;
  const std::string data((std::istreambuf_iterator<char>(stream)),
                         std::istreambuf_iterator<char>());
  if (header->stride == 0 || header->vertices > data.size() / header->stride) return std::nullopt;
  std::string content = std::move(header->text);
  content.reserve(content.size() + data.size() + header->vertices);
  std::size_t at = 0;
  for (std::size_t i = 0; i < header->vertices; ++i, at += header->stride) {
    content += '\xff';
    content.append(data, at, header->stride);
  }
  content.append(data, at, std::string::npos);
  return content;
}

}  // namespace vinerow::io
