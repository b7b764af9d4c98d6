#pragma once
/// Reads mappings of a scenario against parameter specs. Every fault is a ConfigError "file:line:
/// key.path ...".
///
/// Each reading gives the checked values and, beside them, the resolved mapping: the same values
/// with defaults written out, paths absolute and given sources kept.

#include <optional>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/core/time.h"
#include "engine/io/files/yaml.h"

namespace vinerow::scenario {

/// What every reader needs to know.
struct ReadContext {
  const Registry& registry;
  const io::YamlNode&
      root;               ///< the whole merged scenario, searched for where a misplaced key belongs
  Duration physics_step;  ///< periods must be multiples of it
};

struct ReadParameters {
  ParameterSet values;
  io::YamlNode resolved = io::yaml_mapping();
};

/// Reads the keys that `specs` name; other keys are left to the caller (see check_keys).
/// @param where  marks a missing required key. @param owner  who the parameters belong to, for
/// later errors
ReadParameters read_parameters(const io::YamlNode& mapping, const io::SourceMark& where,
                               const std::string& path, const std::vector<ParameterSpec>& specs,
                               const std::string& owner);

/// @throws ConfigError unless the node is a mapping; `example` shows what is expected: "{type:
/// pure_pursuit}".
void require_mapping(const io::YamlNode& node, const std::string& path, const std::string& example);

/// @throws ConfigError for the first key that is not known, with the nearest known one, or where
/// the key belongs.
/// @param owner  "controller 'pure_pursuit'", or "" @param specs  of parameters among the known
/// keys, for their units
void check_keys(const io::YamlNode& mapping, const std::string& path,
                const std::vector<std::string>& known, const std::string& owner,
                const ReadContext* context);

/// @throws ConfigError unless `name` is a valid name. @param what  "vehicle"
void check_name(const io::YamlEntry& entry, const std::string& path, const char* what);

/// @throws ConfigError naming the rate's period, the physics step and the nearest rates that fit.
/// @returns the period
Duration check_rate(double rate_Hz, Duration physics_step, const io::SourceMark& mark,
                    const std::string& path);

/// "a number in m, > 0", "one of: zstd, lz4, none", ...: what a parameter may be.
std::string allowed_text(const ParameterSpec& spec);

/// The known key that a wrong one most likely means: unit suffix missing or other, another case, a
/// typing error; or "".
std::string likely_key(const std::string& wrong, const std::vector<std::string>& known);

/// The absolute path that a text names. @throws ConfigError if empty or, with `must_exist`, missing
std::string read_path(const io::YamlNode& text, const std::string& path, bool must_exist);

std::vector<std::string> names_of(const std::vector<ParameterSpec>& specs);

}  // namespace vinerow::scenario
