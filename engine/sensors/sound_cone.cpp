#include "engine/sensors/sound_cone.h"

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::sensors {

std::vector<ConeRay> cone_rays(double half_angle_rad, int rings) {
  if (half_angle_rad <= 0.0 || rings <= 0) return {ConeRay{}};
  // A ray represents the region nearer to its ring than to the next one; its share is that of the
  // spherical cap.
  const double pitch_rad = half_angle_rad / rings;
  const double cap = 1.0 - std::cos(half_angle_rad);
  const auto inside = [&](double ring) {
    return ring >= rings ? 1.0 : (1.0 - std::cos(ring * pitch_rad)) / cap;
  };
  std::vector<ConeRay> rays{ConeRay{Eigen::Vector3d::UnitX(), 0.0, inside(0.5)}};
  constexpr double kGolden = 0.6180339887498949;
  for (int ring = 1; ring <= rings; ++ring) {
    const int count = 6 * ring;
    const double off_axis_rad = pitch_rad * ring;
    const double share = (inside(ring + 0.5) - inside(ring - 0.5)) / count;
    const double turned = ring == rings ? 0.0 : kGolden * ring - std::floor(kGolden * ring);
    for (int k = 0; k < count; ++k) {
      const double around_rad = 2.0 * kPi * (k + turned) / count;
      rays.push_back({{std::cos(off_axis_rad), std::sin(off_axis_rad) * std::cos(around_rad),
                       std::sin(off_axis_rad) * std::sin(around_rad)},
                      off_axis_rad,
                      share});
    }
  }
  return rays;
}

}  // namespace vinerow::sensors
