#pragma once
/// Shell completion, written from the parser's own declarations.

#include <CLI/CLI.hpp>
#include <string>

namespace vinerow::tools {

/// Scripts for the shell to source. They complete commands, options, values that come from a list,
/// and else names of files.
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string fish_completion(const CLI::App& app);

}  // namespace vinerow::tools
