#include "engine/io/meshes/collada_check.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/io/clouds/point_cloud_scalar.h"

namespace vinerow::io {
namespace {

constexpr std::uint64_t kMaxNodes = 1'000'000;
constexpr int kDeepestNode = 200;
constexpr std::uint64_t kMaxInputs = 100;    // numbers of one corner: position, normal, ...
constexpr std::uint64_t kMaxStride = 1'000;  // numbers of one entry of a source

class ColladaCheck {
 public:
  ColladaCheck(const std::filesystem::path& file, std::uint64_t bytes)
      : file_(file), bytes_(bytes) {}

  void check(const tinyxml2::XMLElement& root) {
    look_at(root);
    for (const auto* accessor : accessors_) check_accessor(*accessor);
    for (const auto& [name, node] : nodes_) count_nodes(*node, name, 0);
  }

 private:
  [[noreturn]] void fail(const std::string& sentence) const {
    throw ConfigError(fmt::format("mesh file '{}' is broken: {}", file_.string(), sentence));
  }

  /// tinyxml2 limits the depth of the recursion.
  void look_at(const tinyxml2::XMLElement& element) {
    const std::string name = element.Name();
    check_number(element, "count", bytes_, ", the file's bytes");
    check_number(element, "stride", kMaxStride, "");
    check_number(element, "offset", name == "input" ? kMaxInputs : bytes_, "");
    if (name == "p" || name == "v" || name == "vcount" || name == "h") check_indices(element);
    if (name == "float_array") check_floats(element);
    if (name == "float_array" || name == "Name_array" || name == "IDREF_array") {
      if (const char* id = element.Attribute("id")) arrays_[id] = &element;  // the last, as assimp
    }
    if (name == "accessor") accessors_.push_back(&element);
    if (name == "node") {
      for (const char* key : {"id", "name"}) {
        if (const char* value = element.Attribute(key)) nodes_.try_emplace(value, &element);
      }
    }
    for (const auto* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      look_at(*child);
    }
  }

  /// Calls back for every word of the element's own text.
  template <class Look>
  static void for_each_word(const tinyxml2::XMLElement& element, const Look& look) {
    for (const auto* node = element.FirstChild(); node != nullptr; node = node->NextSibling()) {
      const tinyxml2::XMLText* text = node->ToText();
      if (text == nullptr) continue;
      std::string_view rest = text->Value();
      constexpr std::string_view kBlanks = " \t\r\n";
      while (true) {
        const std::size_t begin = rest.find_first_not_of(kBlanks);
        if (begin == std::string_view::npos) break;
        rest.remove_prefix(begin);
        const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
        look(word);
        rest.remove_prefix(word.size());
      }
    }
  }

  /// assimp would read on endlessly after a word that is not a number.
  void check_indices(const tinyxml2::XMLElement& element) const {
    for_each_word(element, [&](std::string_view word) {
      const auto number = parse_count(word);
      if (number && *number <= bytes_) return;
      fail(fmt::format("'{}' in <{}> of line {}, must be a whole number up to {}, the file's bytes",
                       word.substr(0, 40), element.Name(), element.GetLineNum(), bytes_));
    });
  }

  void check_floats(const tinyxml2::XMLElement& element) const {
    std::uint64_t count = 0;
    for_each_word(element, [&](std::string_view word) {
      ++count;
      const auto number = parse_number(word);
      if (number && std::isfinite(*number)) return;
      fail(fmt::format("'{}' in <float_array> of line {}, must be a finite number",
                       word.substr(0, 40), element.GetLineNum()));
    });
    const std::uint64_t promised = count_of(element, "count", 0);
    if (count >= promised) return;
    fail(fmt::format("<float_array> of line {} has {} numbers, its count is {}",
                     element.GetLineNum(), count, promised));
  }

  /// assimp looks up entries of an accessor in its array without a bounds check.
  void check_accessor(const tinyxml2::XMLElement& accessor) const {
    const char* source = accessor.Attribute("source");
    const std::uint64_t count = count_of(accessor, "count", 0);
    if (source == nullptr || count == 0) return;
    const auto found = arrays_.find(source[0] == '#' ? source + 1 : source);
    if (found == arrays_.end()) return;  // assimp reports this if it needs the array
    const tinyxml2::XMLElement& array = *found->second;
    if (is_in_mesh(accessor) && std::strcmp(array.Name(), "float_array") != 0) {
      fail(fmt::format("the <accessor> of line {} takes a mesh's numbers from the <{}> of line {}",
                       accessor.GetLineNum(), array.Name(), array.GetLineNum()));
    }
    std::uint64_t of_one = 0;
    for (const auto* param = accessor.FirstChildElement("param"); param != nullptr;
         param = param->NextSiblingElement("param")) {
      ++of_one;
    }
    const std::uint64_t has = count_of(array, "count", 0);
    const std::uint64_t asks = count_of(accessor, "offset", 0) +
                               (count - 1) * count_of(accessor, "stride", 1) +
                               std::max<std::uint64_t>(of_one, 1);
    if (asks <= has) return;
    fail(fmt::format("the <accessor> of line {} takes {} values from the {} of the <{}> of line {}",
                     accessor.GetLineNum(), asks, has, array.Name(), array.GetLineNum()));
  }

  static bool is_in_mesh(const tinyxml2::XMLElement& element) {
    for (const auto* above = element.Parent(); above != nullptr; above = above->Parent()) {
      if (above->ToElement() && std::strcmp(above->ToElement()->Name(), "mesh") == 0) return true;
    }
    return false;
  }

  static std::uint64_t count_of(const tinyxml2::XMLElement& element, const char* key,
                                std::uint64_t otherwise) {
    const char* text = element.Attribute(key);
    return text ? parse_count(text).value_or(otherwise) : otherwise;
  }

  void check_number(const tinyxml2::XMLElement& element, const char* key, std::uint64_t max_value,
                    const char* why) const {
    const char* text = element.Attribute(key);
    if (text == nullptr) return;
    const auto number = parse_count(text);
    if (number && *number <= max_value) return;
    fail(fmt::format("{} = '{}' of <{}> in line {}, must be a whole number up to {}{}", key,
                     std::string(text).substr(0, 40), element.Name(), element.GetLineNum(),
                     max_value, why));
  }

  /// Number of nodes in this subtree, including this node and all instanced nodes.
  std::uint64_t count_nodes(const tinyxml2::XMLElement& node, const std::string& name, int depth) {
    if (depth > kDeepestNode) {
      fail(fmt::format("its nodes are nested deeper than {}", kDeepestNode));
    }
    const auto [found, is_new] = counts_.try_emplace(&node, kBeingCounted);
    if (!is_new) {
      if (found->second == kBeingCounted) fail(fmt::format("the node '{}' contains itself", name));
      return found->second;
    }
    std::uint64_t count = 1;
    for (const auto* child = node.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      if (std::strcmp(child->Name(), "node") == 0) count += count_nodes(*child, name, depth + 1);
      const char* url = child->Attribute("url");
      if (std::strcmp(child->Name(), "instance_node") == 0 && url != nullptr) {
        const std::string wanted = url[0] == '#' ? url + 1 : url;
        const auto instanced = nodes_.find(wanted);
        if (instanced != nodes_.end()) count += count_nodes(*instanced->second, wanted, depth + 1);
      }
      if (count > kMaxNodes) {
        fail(fmt::format("its nodes instance each other more than {} times", kMaxNodes));
      }
    }
    counts_[&node] = count;
    return count;
  }

  static constexpr std::uint64_t kBeingCounted = 0;

  const std::filesystem::path& file_;
  std::uint64_t bytes_;
  std::map<std::string, const tinyxml2::XMLElement*> nodes_;
  std::map<const tinyxml2::XMLElement*, std::uint64_t> counts_;
  std::map<std::string, const tinyxml2::XMLElement*> arrays_;
  std::vector<const tinyxml2::XMLElement*> accessors_;
};

}  // namespace

void check_collada(const std::filesystem::path& file) {
  const std::string text = read_bytes(file).value_or("");
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS ||
      document.RootElement() == nullptr) {
    throw ConfigError(fmt::format("mesh file '{}' cannot be read: it is not XML (line {})",
                                  file.string(), document.ErrorLineNum()));
  }
  // assimp uses the first <COLLADA> among the top-level elements. If another element preceded it,
  // this check would cover only that element.
  const tinyxml2::XMLElement& root = *document.RootElement();
  if (std::strcmp(root.Name(), "COLLADA") != 0) {
    throw ConfigError(
        fmt::format("mesh file '{}' cannot be read: its outermost element is <{}> (line {}), must "
                    "be <COLLADA>",
                    file.string(), std::string(root.Name()).substr(0, 40), root.GetLineNum()));
  }
  if (const auto* second = root.NextSiblingElement()) {
    throw ConfigError(fmt::format(
        "mesh file '{}' cannot be read: <{}> (line {}) is next to "
        "<COLLADA>, but a document has one outermost element",
        file.string(), std::string(second->Name()).substr(0, 40), second->GetLineNum()));
  }
  ColladaCheck(file, text.size()).check(root);
}

}  // namespace vinerow::io
