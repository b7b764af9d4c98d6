#include "engine/io/meshes/mesh_references.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace vinerow::io {
namespace {

/// COLLADA's <asset> is at the top of the file; geometry may have hundreds of megabytes.
std::string read_beginning(const std::filesystem::path& file) {
  std::string text(64 * 1024, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string decode_percent(const std::string& text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hex_value(text[i + 1]) >= 0 &&
        hex_value(text[i + 2]) >= 0) {
      decoded += static_cast<char>(16 * hex_value(text[i + 1]) + hex_value(text[i + 2]));
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

}  // namespace

ColladaAsset read_collada_asset(const std::filesystem::path& file) {
  ColladaAsset asset;
  const std::string text = read_beginning(file);
  const std::string kUpAxis = "<up_axis>";
  if (const std::size_t at = text.find(kUpAxis); at != std::string::npos) {
    const std::size_t axis = text.find_first_of("XYZ", at + kUpAxis.size());
    if (axis != std::string::npos) asset.up_axis = text[axis];
  }
  if (const std::size_t at = text.find("<unit"); at != std::string::npos) {
    const std::string element = text.substr(at, text.find('>', at) - at);
    if (const std::size_t meter = element.find("meter=\""); meter != std::string::npos) {
      const double unit_m = std::strtod(element.c_str() + meter + 7, nullptr);
      if (unit_m > 0.0) asset.unit_m = unit_m;
    }
  }
  return asset;
}

std::vector<std::string> read_material_libraries(const std::filesystem::path& obj_file) {
  std::vector<std::string> libraries;
  std::ifstream stream(obj_file);
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("mtllib ", 0) != 0) continue;
    std::string name = line.substr(7);
    while (!name.empty() && (name.back() == '\r' || name.back() == ' ')) name.pop_back();
    if (!name.empty()) libraries.push_back(name);
  }
  return libraries;
}

std::optional<std::filesystem::path> find_reference(const std::filesystem::path& mesh_file,
                                                    const std::string& reference) {
  std::string name = reference;
  if (name.rfind("file://", 0) == 0) name.erase(0, 7);
  std::replace(name.begin(), name.end(), '\\', '/');
  for (const std::string& candidate : {name, decode_percent(name)}) {
    const std::filesystem::path path = mesh_file.parent_path() / candidate;
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error)) {
      return std::filesystem::absolute(path).lexically_normal();
    }
  }
  return std::nullopt;
}

}  // namespace vinerow::io
