#include "tools/vinerow/scale_bar.h"

#include <fmt/format.h>

#include <cmath>

namespace vinerow::tools {

void draw_scale_bar(Canvas& canvas, const Eigen::Vector2d& right_end, double wanted_m,
                    double px_per_m, const Rgb& ink) {
  double length_m = std::pow(10.0, std::floor(std::log10(wanted_m)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * length_m > wanted_m) continue;
    length_m *= factor;
    break;
  }
  const double right = right_end.x(), y = right_end.y(), left = right - length_m * px_per_m;
  canvas.line({left, y}, {right, y}, 3.0, ink);
  for (const double x : {left, right}) canvas.line({x, y - 6}, {x, y + 6}, 2.0, ink);
  canvas.text(fmt::format("{:g} m", length_m), 17, {0.5 * (left + right), y - 10}, ink, 0.5);
  const double x = left - 40.0;
  canvas.fill({{x, y - 26}, {x + 8, y + 6}, {x, y - 1}, {x - 8, y + 6}}, ink);
  canvas.text("N", 15, {x, y - 31}, ink, 0.5);
}

}  // namespace vinerow::tools
