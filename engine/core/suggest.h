#pragma once
/// Name suggestions: the known name that is nearest to a wrong one ("did you mean ...?").

#include <span>
#include <string>
#include <string_view>

namespace vinerow {

/// Number of single-character insertions, deletions, replacements and swaps of neighbours between
/// two names.
int edit_distance(std::string_view a, std::string_view b);

/// @returns the known name with the smallest edit distance (the first of equals), or "" if every
/// name is farther than a third of the wrong name's length plus one; a suggestion would then be a
/// guess
std::string nearest_name(std::string_view wrong, std::span<const std::string> known);

/// "; did you mean 'lookahead_m'?", or "" if no name is near. For the end of an error text.
std::string did_you_mean(std::string_view wrong, std::span<const std::string> known);

/// "a, b, c": list of allowed values.
std::string join(std::span<const std::string> names, std::string_view separator = ", ");

}  // namespace vinerow
