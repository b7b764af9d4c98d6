#pragma once
/// Outlines of leaves: flat, about the junction with the stalk.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

namespace vinerow::worlds {

enum class LeafKind : std::uint8_t {
  kGrapevine,  ///< five lobes
  kApple,      ///< an ellipse, 7.5 cm by 4.5 cm in its proportions
  kOlive       ///< a lance, 6 cm by 1.25 cm
};

/// Points of the outline, counter-clockwise seen from the upper face: x from the junction towards
/// the tip, y to the left; the tip is at (1, 0). @param level  0 near, 1, 2 far
std::span<const Eigen::Vector2d> leaf_outline(LeafKind kind, int level);

/// Edge of an outline that does not belong to the blade: it passes over the stalk. From this point
/// to the next. @param points  number of the outline's points
constexpr std::size_t open_edge(std::size_t points) {
  return points / 2;
}

/// From the junction to the tip, for a flat blade of this area. @param area_m2  of the blade
double leaf_length_m(LeafKind kind, double area_m2, int level = 0);

}  // namespace vinerow::worlds
