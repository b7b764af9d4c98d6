#pragma once
/// Files that the build embeds in the program.

#include <string_view>
#include <vector>

namespace vinerow::tools {

/// three.js and the examples of it that a replay uses, in loading order; empty if the build did not
/// find them.
std::vector<std::string_view> three_scripts();
/// Its licence.
std::string_view three_notice();

/// Files of a replay, in the order a page loads them.
std::string_view replay_style();
std::string_view replay_markup();
std::vector<std::string_view> replay_scripts();

}  // namespace vinerow::tools
