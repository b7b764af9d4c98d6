#pragma once
/// Reader of scenario mappings by parameter specs. Every fault is a ConfigError "file:line:
/// key.path ...".
///
/// Each function returns the checked values and the resolved mapping: the same values with defaults
/// written out, absolute paths, and sources kept.

#include <optional>
#include <string>
#include <vector>

#include "engine/api/registry.h"
#include "engine/core/time.h"
#include "engine/io/files/yaml.h"

namespace vinerow::scenario {

/// Context of all readers.
struct ReadContext {
  const Registry& registry;
  const io::YamlNode&
      root;  ///< the whole merged scenario, searched to find where a misplaced key belongs
  Duration physics_step;                         ///< periods must be multiples of it
  std::vector<std::string>* warnings = nullptr;  ///< of the scenario, may be null
};

struct ReadParameters {
  ParameterSet values;
  io::YamlNode resolved = io::yaml_mapping();
};

/// Reads the keys that `specs` name; other keys are left to the caller (see check_keys).
/// @param where  mark for errors about missing keys. @param owner  owner of the parameters, for
/// later errors
ReadParameters read_parameters(const io::YamlNode& mapping, const io::SourceMark& where,
                               const std::string& path, const std::vector<ParameterSpec>& specs,
                               const std::string& owner);

/// @throws ConfigError unless the node is a mapping; `example` shows what is expected: "{type:
/// pure_pursuit}".
void require_mapping(const io::YamlNode& node, const std::string& path, const std::string& example);

/// @throws ConfigError for the first unknown key, with the nearest known key or the place where the
/// key belongs.
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

/// "a number in m, > 0", "one of: zstd, lz4, none", ...: allowed values of a parameter.
std::string allowed_text(const ParameterSpec& spec);

/// The known key that is probably meant: unit suffix missing or different, other case, typing
/// error; or "".
std::string likely_key(const std::string& wrong, const std::vector<std::string>& known);

/// The absolute path of a text. @throws ConfigError if empty or, with `must_exist`, missing
std::string read_path(const io::YamlNode& text, const std::string& path, bool must_exist);

std::vector<std::string> names_of(const std::vector<ParameterSpec>& specs);

}  // namespace vinerow::scenario
