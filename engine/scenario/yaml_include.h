#pragma once
/// `include`: any mapping may take over the contents of other files, and change them.
///
/// Order: the files of an `include` list are merged from first to last, then the mapping's own keys
/// win. Merging is deep: mappings are merged key by key, everything else (numbers, texts, lists) is
/// replaced. `key: null` takes an included key away. Three mappings are replaced as a whole, since
/// a mixture would make no sense: {value, source}, a part whose `type` (a camera whose `kind`)
/// changes, except a vehicle, and a `spawn` of another form.

#include <filesystem>
#include <string>

#include "engine/io/files/yaml.h"

namespace vinerow::scenario {

/// Loads a file with all its includes. Paths are relative to the file that names them. Marks tell
/// the true file and line.
/// @throws ConfigError for missing, unreadable, cyclic (the chain is named) or empty files
io::YamlNode load_yaml_with_includes(const std::filesystem::path& file);

/// The same for a tree that came from elsewhere (a text, a `--set` value). @param path  key path of
/// the tree, for errors
void resolve_includes(io::YamlNode& tree, const std::string& path);

/// Deep merge as described above. @param path  key path of both, which decides what counts as a
/// vehicle or a spawn
void merge_over(io::YamlNode& base, io::YamlNode over, const std::string& path);

/// True for {value: ..., source: ...}, the form in which a parameter tells where its value comes
/// from.
bool is_sourced_value(const io::YamlNode& node);

/// "a.b" from "a" and "b".
std::string join_path(const std::string& path, const std::string& key);

}  // namespace vinerow::scenario
