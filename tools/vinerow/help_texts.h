#pragma once
/// Groups of commands, examples and exit statuses for the help texts.

#include <CLI/CLI.hpp>

namespace vinerow::tools {

/// Adds them to every command. @pre all commands are added, and each has an entry in the table
void add_help_texts(CLI::App& app);

}  // namespace vinerow::tools
