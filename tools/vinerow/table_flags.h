#pragma once
/// Flags of a command that are the rows of a parameter table: `slice_m` becomes `--slice`.
///
/// Unit, range, words and default of a flag are the table's, and a value goes through
/// ParameterSet::set, so a fault is told by the loader's sentence.

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/parameters.h"

namespace vinerow::tools {

struct TableFlags {
  std::vector<std::string> without;          ///< keys that get no flag
  std::map<std::string, std::string> names;  ///< key, its flag; the key's own name stays an alias
  std::string group;                         ///< heading of the flags in the help
  std::vector<std::string> general;          ///< keys whose flags stand under no heading
};

/// The flag of a key: without the suffix of its unit, `_` as `-`. A truth value also has its
/// opposite, `--no-...`.
/// @returns "--slice" for `slice_m`, "--density" for `density_per_m2`
std::string flag_name(const ParameterSpec& spec);

/// @pre no groups among the specs that get a flag
/// @returns the values: defaults, and after parsing what the user gave. Parsing throws ConfigError
/// "--slice: slice_m = 9 m, must be >= 0.02 m and <= 5 m"
std::shared_ptr<const ParameterSet> add_table_flags(CLI::App& command,
                                                    const std::vector<ParameterSpec>& specs,
                                                    const TableFlags& flags);

}  // namespace vinerow::tools
