#pragma once
/// Files that the build puts into the program.

#include <string_view>
#include <vector>

namespace vinerow::tools {

/// three.js and those of its examples that a replay uses, in the order a page loads them; empty
/// where the build found none.
std::vector<std::string_view> three_scripts();
/// Its licence.
std::string_view three_notice();

/// What a replay consists of, in the order a page loads it.
std::string_view replay_style();
std::string_view replay_markup();
std::vector<std::string_view> replay_scripts();

}  // namespace vinerow::tools
