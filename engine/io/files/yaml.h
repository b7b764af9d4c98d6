#pragma once
/// YAML as plain data that remembers where each value was written, so that every fault can name its
/// line.
///
/// The dialect is YAML 1.2's core schema, one document per file, keys are texts. Refused with file
/// and line: duplicate keys, tabs as indentation, control characters, tags other than !!str, merge
/// keys (`include` does that here).

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
  std::filesystem::path folder;    ///< absolute; relative paths written in this node start here
  std::string text;                ///< of a scalar, as written
  bool quoted = false;             ///< a scalar in quotes is always a text
  bool flow = false;               ///< to be printed in one line: {a: 1, b: 2}
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
  /// Appends, or replaces the value of a key that is there already.
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
YamlNode yaml_number(double value);  ///< shortest text that reads back as the same double
YamlNode yaml_integer(std::int64_t value);
YamlNode yaml_boolean(bool value);

/// A scalar by the core schema: quoted or not matching anything else = text; whole numbers beyond
/// 64 bits and numbers beyond double become double (infinite where they overflow). `.inf` and
/// `.nan` are doubles.
using YamlScalar = std::variant<std::string, bool, std::int64_t, double>;
YamlScalar scalar_value(const YamlNode& scalar);

/// @param file_name  how errors name the text; @param folder  absolute, start of relative paths
/// @throws ConfigError "file.yaml:7: ..." An empty text is a null node.
YamlNode parse_yaml(const std::string& text, const std::string& file_name,
                    const std::filesystem::path& folder);
/// @param file  as the user wrote it: errors name it so. @throws ConfigError also for a file that
/// cannot be read
YamlNode load_yaml_file(const std::filesystem::path& file);
/// The same with another name in errors and marks.
YamlNode load_yaml_file_as(const std::filesystem::path& file, const std::string& shown_name);

/// Block style with two spaces; nodes with `flow` and lists of scalars in one line. Reading it back
/// gives an equal tree.
std::string to_yaml(const YamlNode& node);

/// "x.yaml:7: sentence" as ConfigError in one line: control characters are shown as escapes.
[[noreturn]] void fail_at(const SourceMark& mark, const std::string& sentence);
/// A value as errors show it: 0.5, 'text' (cut after 60 characters), a list, a mapping, nothing.
std::string shown(const YamlNode& node);
/// "; did you mean 'rows.geojson'?" from the files beside a missing one, or "".
std::string nearest_file_hint(const std::filesystem::path& missing);

}  // namespace vinerow::io
