#pragma once
/// Table with aligned columns for a terminal.

#include <string>
#include <vector>

namespace vinerow::tools {

/// The first column is left-aligned, the others right-aligned. Control characters become '?'.
/// @param rows  heading first; shorter rows are allowed
std::string text_table(const std::vector<std::vector<std::string>>& rows);

/// Text of unknown origin, made safe for a terminal.
std::string printable(std::string text);

}  // namespace vinerow::tools
