#include "engine/sim/map_ground.h"

#include <algorithm>

#include "engine/api/height_field.h"

namespace vinerow {

std::optional<double> MapGround::ground_height_m(double x, double y, double z_from) const {
  constexpr double kBeyond_m = 10.0;
  const auto outside_m = [](double at, double from, double length) {
    return std::max({from - at, at - from - length, 0.0});
  };
  if (outside_m(x, terrain_.corner_W.x(), terrain_.width_m()) > kBeyond_m ||
      outside_m(y, terrain_.corner_W.y(), terrain_.depth_m()) > kBeyond_m) {
    return std::nullopt;
  }
  const double height_m = terrain_.height_m(x, y);
  return height_m <= z_from ? std::optional(height_m) : std::nullopt;
}

}  // namespace vinerow
