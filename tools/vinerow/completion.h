#pragma once
/// Shell completion scripts, generated from the parser's declarations.

#include <CLI/CLI.hpp>
#include <string>

namespace vinerow::tools {

/// Scripts for the shell to source. They complete commands, options, values from fixed lists, and
/// otherwise file names.
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string fish_completion(const CLI::App& app);

}  // namespace vinerow::tools
