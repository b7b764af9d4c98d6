#pragma once
/// `--set a.b.c=value` and `--seed`: values from the command line, written over the merged file.

#include <string>

#include "engine/io/files/yaml.h"
#include "engine/scenario/scenario.h"

namespace vinerow::scenario {

/// Writes all overrides into the merged scenario, in order. What they say is checked afterwards
/// with everything else; the marks of the written values name the `--set` text. A relative path in
/// a value starts at `folder`.
/// @throws ConfigError naming the `--set` text: no '=', bad YAML, unknown start of the path, index
/// out of range
void apply_overrides(io::YamlNode& root, const Overrides& overrides,
                     const std::filesystem::path& folder);

}  // namespace vinerow::scenario
