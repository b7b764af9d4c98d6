#pragma once
/// What the help says beside the options: groups of commands, examples, exit statuses.

#include <CLI/CLI.hpp>

namespace vinerow::tools {

/// @pre all commands are added; each has its line in the table
void add_help_texts(CLI::App& app);

}  // namespace vinerow::tools
