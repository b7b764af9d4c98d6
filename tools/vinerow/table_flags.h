#pragma once
/// Command-line flags made from a parameter table: `slice_m` becomes `--slice`.
///
/// Unit, range, description and default of a flag come from the table. A value goes through
/// ParameterSet::set, so an invalid one gives the loader's message.

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/parameters.h"

namespace vinerow::tools {

struct TableFlags {
  std::vector<std::string> without;          ///< keys without a flag
  std::map<std::string, std::string> names;  ///< key to flag; the key's own name stays an alias
  std::string group;                         ///< heading of the flags in the help
  std::vector<std::string> general;          ///< keys whose flags have no heading
};

/// Flag of a key: the key without its unit suffix, with `-` for `_`. A boolean also has the
/// opposite flag `--no-...`.
/// @returns "--slice" for `slice_m`, "--density" for `density_per_m2`
std::string flag_name(const ParameterSpec& spec);

/// @pre no spec that gets a flag is a group
/// @returns the values: defaults, after parsing overridden by the user's. Parsing throws
/// ConfigError
/// "--slice: slice_m = 9 m, must be >= 0.02 m and <= 5 m"
std::shared_ptr<const ParameterSet> add_table_flags(CLI::App& command,
                                                    const std::vector<ParameterSpec>& specs,
                                                    const TableFlags& flags);

}  // namespace vinerow::tools
