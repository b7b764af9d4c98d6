#pragma once
/// Colours of words on a terminal.

#include <string>
#include <string_view>

namespace vinerow::tools {

enum class Colour { kPlain, kGood, kBad, kHeading };
enum class ColourMode { kAuto, kAlways, kNever };

/// Of everything that is printed from now on. Auto: where standard output is a terminal, unless the
/// variable NO_COLOR is set (no-color.org) or TERM is "dumb".
void set_colour_mode(ColourMode mode);

/// The text, in colour where that is wanted.
std::string coloured(std::string_view text, Colour colour);

}  // namespace vinerow::tools
