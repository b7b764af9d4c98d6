#pragma once
/// "Did you mean ...?": the nearest known name to a wrong one.

#include <span>
#include <string>
#include <string_view>

namespace vinerow {

/// Number of single-character insertions, deletions, replacements and swaps of neighbours between
/// two names.
int edit_distance(std::string_view a, std::string_view b);

/// @returns the known name with the smallest edit distance (the first of equals), or "" if every
/// one is
///          farther than a third of its length plus one, which would be a guess and no help.
std::string nearest_name(std::string_view wrong, std::span<const std::string> known);

/// "; did you mean 'lookahead_m'?" or "" if nothing is near. Ready to append to an error text.
std::string did_you_mean(std::string_view wrong, std::span<const std::string> known);

/// "a, b, c": for listing what is allowed.
std::string join(std::span<const std::string> names, std::string_view separator = ", ");

}  // namespace vinerow
