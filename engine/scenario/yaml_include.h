#pragma once
/// The key `include`: a mapping may take over the contents of other files and change them.
///
/// Order: the files of an `include` list are merged from first to last; the mapping's own keys
/// override them. Merging is deep: mappings are merged key by key, all other values (numbers,
/// texts, lists) are replaced. `key: null` removes an included key. Three kinds of mappings are
/// replaced as a whole, since a mixture would be meaningless: {value, source}; a part (except a
/// vehicle) with another `type` or a camera with another `kind`; and a `spawn` of another form.

#include <filesystem>
#include <string>

#include "engine/io/files/yaml.h"

namespace vinerow::scenario {

/// Loads a file with all its includes. Paths are relative to the file that names them. Marks hold
/// the original file and line.
/// @throws ConfigError for missing, unreadable, empty or cyclic files (with the include chain)
io::YamlNode load_yaml_with_includes(const std::filesystem::path& file);

/// Resolves the includes of a tree from another source (a text, a `--set` value). @param path  key
/// path of the tree, for errors
void resolve_includes(io::YamlNode& tree, const std::string& path);

/// Deep merge as described above. @param path  key path of both, which identifies vehicles and
/// spawns
void merge_over(io::YamlNode& base, io::YamlNode over, const std::string& path);

/// True for {value: ..., source: ...}, a value with a note on its origin.
bool is_sourced_value(const io::YamlNode& node);

/// "a.b" from "a" and "b".
std::string join_path(const std::string& path, const std::string& key);

}  // namespace vinerow::scenario
