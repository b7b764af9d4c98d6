#pragma once
/// Aligned columns for a terminal.

#include <string>
#include <vector>

namespace vinerow::tools {

/// The first column stands left, the others right. Control characters are replaced by '?'.
/// @param rows  the heading first; shorter rows end early
std::string text_table(const std::vector<std::vector<std::string>>& rows);

/// A text of unknown origin, fit for a terminal.
std::string printable(std::string text);

}  // namespace vinerow::tools
