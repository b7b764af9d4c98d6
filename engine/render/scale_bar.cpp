#include "engine/render/scale_bar.h"

#include <fmt/format.h>

#include <cmath>

namespace vinerow::render {

double scale_length_m(double max_m) {
  const double length_m = std::pow(10.0, std::floor(std::log10(max_m)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * length_m <= max_m) return factor * length_m;
  }
  return length_m;
}

double draw_scale_bar(Canvas& canvas, const Eigen::Vector2d& right_end, double wanted_m,
                      double px_per_m, const Rgb& ink, double size) {
  const double length_m = scale_length_m(wanted_m);
  const auto text_px = [size](int px) { return static_cast<int>(std::lround(px * size)); };
  const double right = right_end.x(), y = right_end.y(), left = right - length_m * px_per_m;
  canvas.line({left, y}, {right, y}, 3.0 * size, ink);
  for (const double x : {left, right}) {
    canvas.line({x, y - 6 * size}, {x, y + 6 * size}, 2.0 * size, ink);
  }
  canvas.text(fmt::format("{:g} m", length_m), text_px(17), {0.5 * (left + right), y - 10 * size},
              ink, 0.5);
  const double x = left - 40.0 * size, half = 8.0 * size;
  canvas.fill(
      {{x, y - 26 * size}, {x + half, y + 6 * size}, {x, y - size}, {x - half, y + 6 * size}}, ink);
  canvas.text("N", text_px(15), {x, y - 31 * size}, ink, 0.5);
  return x - half;
}

}  // namespace vinerow::render
