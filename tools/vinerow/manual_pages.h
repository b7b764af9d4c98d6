#pragma once
/// Manual pages for man(1), generated from the parser's declarations.

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

namespace vinerow::tools {

/// One page for the program and one for each command, in the language of groff's `man` macros.
/// @param app  all commands and help texts added
/// @returns names of files ("vinerow.1", "vinerow-run.1") and their texts
std::vector<std::pair<std::string, std::string>> manual_pages(const CLI::App& app);

}  // namespace vinerow::tools
