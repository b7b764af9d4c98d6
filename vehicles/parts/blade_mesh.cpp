#include "vehicles/parts/blade_mesh.h"

#include <cmath>
#include <vector>

#include "engine/math/angles.h"

namespace vinerow::vehicles {

using Eigen::Vector3d;

/// Flat facets over four edges per section: leading, upper, trailing, lower.
void append_blade(double radius_m, double mirror, unsigned blade_srgb, unsigned tip_srgb,
                  MeshBuilder& b) {
  constexpr int kSections = 14;
  struct Section {
    Vector3d lead, upper, trail, lower;
  };
  std::vector<Section> sections;
  for (int k = 0; k <= kSections; ++k) {
    const double s = static_cast<double>(k) / kSections;
    const double r = radius_m * (0.07 + 0.93 * s);
    // Chord: narrow root, widest at a third, rounded tip. Twist of a constant pitch.
    const double shape = 0.45 + 1.9 * s * (1.0 - s) * (1.0 - 0.55 * s) + 0.12 * (1.0 - s);
    const double tip =
        s > 0.92 ? std::sqrt(std::max(0.0, 1.0 - std::pow((s - 0.92) / 0.08, 2))) : 1.0;
    const double chord = 0.135 * radius_m * shape * std::max(tip, 0.08);
    const double pitch_rad = std::min(0.5, std::atan2(0.33 * 2.0 * radius_m, 2.0 * kPi * r));
    const double thick = 0.10 * chord * (1.25 - 0.5 * s);
    const Vector3d along(0.0, mirror * std::cos(pitch_rad), std::sin(pitch_rad));
    const Vector3d normal(0.0, -mirror * std::sin(pitch_rad), std::cos(pitch_rad));
    const Vector3d middle(r, 0.0, 0.0);
    sections.push_back(
        {middle + 0.45 * chord * along, middle + 0.15 * chord * along + thick * normal,
         middle - 0.55 * chord * along, middle + 0.15 * chord * along - 0.4 * thick * normal});
  }
  const auto facet = [&](const Vector3d& p00, const Vector3d& p10, const Vector3d& p11,
                         const Vector3d& p01) {
    if (mirror > 0.0) {
      b.quad(p00, p10, p11, p01);
    } else {
      b.quad(p01, p11, p10, p00);
    }
  };
  for (int k = 0; k < kSections; ++k) {
    b.colour(colour_from_srgb(k >= kSections - 2 ? tip_srgb : blade_srgb));
    const Section &m = sections[static_cast<std::size_t>(k)],
                  &n = sections[static_cast<std::size_t>(k) + 1];
    facet(m.upper, n.upper, n.lead, m.lead);
    facet(m.trail, n.trail, n.upper, m.upper);
    facet(m.lead, n.lead, n.lower, m.lower);
    facet(m.lower, n.lower, n.trail, m.trail);
  }
}

}  // namespace vinerow::vehicles
