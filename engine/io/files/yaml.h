#pragma once
/// YAML tree with the source line of each value, so that every error can name its line.
///
/// The dialect is YAML 1.2's core schema, one document per file, keys are texts. Rejected with file
/// and line: duplicate keys, tabs as indentation, control characters, tags other than !!str, merge
/// keys (use `include`).

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "engine/io/files/source_mark.h"

namespace vinerow::io {

enum class YamlKind { kNull, kScalar, kList, kMapping };

struct YamlEntry;

struct YamlNode {
  YamlKind kind = YamlKind::kNull;
  SourceMark mark;
  std::filesystem::path folder;    ///< absolute; base of relative paths in this node
  std::string text;                ///< of a scalar, as written
  bool quoted = false;             ///< a quoted scalar is always a text
  bool flow = false;               ///< printed in one line: {a: 1, b: 2}
  std::vector<YamlNode> items;     ///< of a list
  std::vector<YamlEntry> entries;  ///< of a mapping, in file order, keys unique

  bool is_null() const { return kind == YamlKind::kNull; }
  bool is_scalar() const { return kind == YamlKind::kScalar; }
  bool is_list() const { return kind == YamlKind::kList; }
  bool is_mapping() const { return kind == YamlKind::kMapping; }

  const YamlNode* find(std::string_view key) const;  ///< nullptr if absent or not a mapping
  YamlNode* find(std::string_view key);
  const YamlEntry* find_entry(std::string_view key) const;
  bool has(std::string_view key) const { return find(key) != nullptr; }
  /// Appends a key, or replaces its value if the key exists.
  void put(std::string key, YamlNode value);
  void erase(std::string_view key);
};

struct YamlEntry {
  std::string key;
  SourceMark mark;  ///< of the key
  YamlNode value;
};

YamlNode yaml_mapping();
YamlNode yaml_list();
YamlNode yaml_text(std::string text);
YamlNode yaml_number(double value);  ///< shortest text that is read back as the same double
YamlNode yaml_integer(std::int64_t value);
YamlNode yaml_boolean(bool value);

/// Value of a scalar by the core schema. It is a text if it is quoted or matches no other kind.
/// Whole numbers beyond 64 bits become double; numbers beyond the range of double become infinite.
/// `.inf` and `.nan` are doubles.
using YamlScalar = std::variant<std::string, bool, std::int64_t, double>;
YamlScalar scalar_value(const YamlNode& scalar);

/// @param file_name  name of the text in errors @param folder  absolute, base of relative paths
/// @throws ConfigError "file.yaml:7: ..." An empty text is a null node.
YamlNode parse_yaml(const std::string& text, const std::string& file_name,
                    const std::filesystem::path& folder);
/// @param file  as the user wrote it, also in errors. @throws ConfigError also if the file cannot
/// be read
YamlNode load_yaml_file(const std::filesystem::path& file);
/// The same with a different name in errors and marks.
YamlNode load_yaml_file_as(const std::filesystem::path& file, const std::string& shown_name);

/// Prints a tree in block style with two spaces; nodes with `flow` and lists of scalars in one
/// line. Parsing the text gives an equal tree.
std::string to_yaml(const YamlNode& node);

/// Throws ConfigError "x.yaml:7: sentence" in one line; control characters are shown as escapes.
[[noreturn]] void fail_at(const SourceMark& mark, const std::string& sentence);
/// A value as shown in errors: 0.5, 'text' (cut after 60 characters), a list, a mapping, nothing.
std::string shown(const YamlNode& node);
/// "; did you mean 'rows.geojson'?" from the files in the folder of a missing one, or "".
std::string nearest_file_hint(const std::filesystem::path& missing);

}  // namespace vinerow::io
