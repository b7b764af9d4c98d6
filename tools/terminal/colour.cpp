#include "tools/terminal/colour.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace vinerow::tools {
namespace {

bool wants_colour_by_itself() {
  const char* no_colour = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return isatty(STDOUT_FILENO) == 1 && !(no_colour && *no_colour) &&
         std::string_view(terminal ? terminal : "") != "dumb";
}

bool& in_colour() {
  static bool wanted = wants_colour_by_itself();
  return wanted;
}

}  // namespace

void set_colour_mode(ColourMode mode) {
  in_colour() =
      mode == ColourMode::kAlways || (mode == ColourMode::kAuto && wants_colour_by_itself());
}

std::string coloured(std::string_view text, Colour colour) {
  if (!in_colour() || colour == Colour::kPlain) return std::string(text);
  const int code = colour == Colour::kGood ? 32 : colour == Colour::kBad ? 31 : 1;
  return fmt::format("\x1b[{}m{}\x1b[0m", code, text);
}

}  // namespace vinerow::tools
