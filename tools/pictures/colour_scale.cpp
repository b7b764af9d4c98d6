#include "tools/pictures/colour_scale.h"

#include <algorithm>
#include <cmath>

namespace vinerow::tools {
namespace {

constexpr std::array<Rgb, 11> kViridis = {{{68, 1, 84},
                                           {72, 36, 117},
                                           {65, 68, 135},
                                           {53, 95, 141},
                                           {42, 120, 142},
                                           {33, 145, 140},
                                           {34, 168, 132},
                                           {68, 191, 112},
                                           {122, 209, 81},
                                           {189, 223, 38},
                                           {253, 231, 37}}};

}  // namespace

Rgb viridis(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kViridis.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
  Rgb colour;
  for (std::size_t c = 0; c < 3; ++c) {
    const double from = kViridis[low][c], to = kViridis[low + 1][c];
    colour[c] = static_cast<int>(std::lround(from + (at - static_cast<double>(low)) * (to - from)));
  }
  return colour;
}

std::vector<double> ticks(double from, double to, int max_count) {
  if (!(to > from) || max_count < 1) return {from};
  double step = std::pow(10.0, std::floor(std::log10((to - from) / max_count)));
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    if ((to - from) / (factor * step) <= max_count) {
      step *= factor;
      break;
    }
  }
  std::vector<double> values;
  const auto first = static_cast<std::int64_t>(std::ceil(from / step - 1e-9));
  for (std::int64_t i = first; static_cast<double>(i) * step <= to + 1e-9 * step; ++i) {
    values.push_back(static_cast<double>(i) * step);
  }
  return values;
}

}  // namespace vinerow::tools
