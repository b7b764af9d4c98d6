#pragma once
/// Overrides of scenario values: `--set a.b.c=value`, `--seed` and values of a study.

#include <string>

#include "engine/io/files/yaml.h"
#include "engine/scenario/scenario.h"

namespace vinerow::scenario {

/// Writes all overrides into the merged scenario, in order. The values are checked later with all
/// others; their marks name the `--set` text. Relative paths in values start at `folder`.
/// @throws ConfigError naming the `--set` text: no '=', bad YAML, unknown first key of the path,
/// index out of range
void apply_overrides(io::YamlNode& root, const Overrides& overrides,
                     const std::filesystem::path& folder);

}  // namespace vinerow::scenario
