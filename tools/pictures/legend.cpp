#include "tools/pictures/legend.h"

#include <fmt/format.h>

#include "tools/pictures/picture_style.h"

namespace vinerow::tools {

void draw_colour_bar(Canvas& canvas, double left, double top, double width, double height,
                     const std::function<Rgb(double share)>& colour) {
  for (int x = 0; x < width; ++x) {
    canvas.fill(render::rectangle(left + x, top, left + x + 1, top + height),
                colour((x + 0.5) / width));
  }
  canvas.outline(render::rectangle(left, top, left + width, top + height), 1.0, kFaint, 0.7);
}

void draw_legend_patch(Canvas& canvas, double x, double y, const Rgb& colour,
                       const std::string& words) {
  const auto patch = render::rectangle(x, y, x + 22, y + 15);
  canvas.fill(patch, colour);
  canvas.outline(patch, 1.0, kFaint, 0.6);
  canvas.text(words, 16, {x + 30, y + 13.5}, kInk);
}

std::string share_text(std::int64_t part, std::int64_t all) {
  const double percent =
      all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0.0;
  return part > 0 && percent < 0.5 ? "< 1 %" : fmt::format("{:.0f} %", percent);
}

}  // namespace vinerow::tools
