#pragma once
/// Takes a replay's page apart again.

#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace vinerow::test {

/// Source: RFC 4648, section 4. Written apart from the encoder.
inline std::string decode_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned buffer = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) throw std::runtime_error("not base64");
    buffer = (buffer << 6 | static_cast<unsigned>(digit)) & 0xffffu;
    bits += 6;
    if (bits >= 8) bytes += static_cast<char>(buffer >> (bits -= 8) & 0xffu);
  }
  return bytes;
}

/// Text of the element <script id="vinerow-replay-NAME">.
inline std::string data_of(const std::string& page, const std::string& name) {
  const std::size_t id = page.find("id=\"vinerow-replay-" + name + "\">");
  if (id == std::string::npos) throw std::runtime_error("the page has no " + name);
  const std::size_t begin = page.find('>', id) + 1;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

struct ReplayPage {
  nlohmann::json index;
  std::string scene, tracks, textures;

  explicit ReplayPage(const std::string& page)
      : index(nlohmann::json::parse(data_of(page, "index"))),
        scene(decode_base64(data_of(page, "scene"))),
        tracks(decode_base64(data_of(page, "tracks"))),
        textures(decode_base64(data_of(page, "textures"))) {}

  /// `count` numbers of the tracks from an offset of the index on.
  template <class T>
  std::vector<T> numbers(const nlohmann::json& offset, std::size_t count) const {
    std::vector<T> values(count);
    const std::size_t begin = offset.get<std::size_t>();
    if (begin % 4 != 0 || begin + count * sizeof(T) > tracks.size()) {
      throw std::runtime_error("outside of the tracks");
    }
    std::memcpy(values.data(), tracks.data() + begin, count * sizeof(T));
    return values;
  }
};

/// The JSON chunk of a binary glTF file. Source: glTF 2.0, section 4.4.
inline nlohmann::json gltf_of(const std::string& glb) {
  std::uint32_t words[5];
  if (glb.size() < sizeof(words)) throw std::runtime_error("no glTF");
  std::memcpy(words, glb.data(), sizeof(words));
  if (glb.compare(0, 4, "glTF") != 0 || words[1] != 2 || words[2] != glb.size() ||
      glb.compare(16, 4, "JSON") != 0) {
    throw std::runtime_error("no glTF");
  }
  return nlohmann::json::parse(glb.substr(20, words[3]));
}

}  // namespace vinerow::test
