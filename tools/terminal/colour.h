#pragma once
/// Coloured text on a terminal.

#include <string>
#include <string_view>

namespace vinerow::tools {

enum class Colour { kPlain, kGood, kBad, kHeading };
enum class ColourMode { kAuto, kAlways, kNever };

/// Sets the mode for all later output. Auto: colours if standard output is a terminal, unless the
/// variable NO_COLOR is set (no-color.org) or TERM is "dumb".
void set_colour_mode(ColourMode mode);

/// The text, in colour if the mode requires it.
std::string coloured(std::string_view text, Colour colour);

}  // namespace vinerow::tools
