#pragma once
/// Shell completion scripts, generated from the parser's declarations.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vinerow::tools {

/// Scripts for the shell to source. They complete commands, options, values from fixed lists, and
/// otherwise file names; bash also completes installed scenarios, studies and vehicles.
/// @param parts  kinds and names of parts, for `list`
std::string bash_completion(const CLI::App& app, const std::vector<std::string>& parts);
std::string zsh_completion(const CLI::App& app, const std::vector<std::string>& parts);
std::string fish_completion(const CLI::App& app, const std::vector<std::string>& parts);

}  // namespace vinerow::tools
