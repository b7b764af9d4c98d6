#pragma once
/// Colours of a run's vehicles, in the scenario's order: for their trails in frames and in the
/// replay, and for their lines in the report.

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace vinerow::playback {

struct VehicleColour {
  Eigen::Vector3f rgb;   ///< 0..1, over grass and on dark pages
  const char* on_paper;  ///< the same hue, dark enough for a line on white, "#rrggbb"
};

/// Further vehicles start again with the first colour.
inline const std::array<VehicleColour, 8> kVehicleColours = {{{{1.0f, 0.72f, 0.05f}, "#b87700"},
                                                              {{1.0f, 0.3f, 0.7f}, "#cf1f87"},
                                                              {{0.3f, 0.95f, 0.9f}, "#0f8f88"},
                                                              {{0.49f, 0.71f, 1.0f}, "#2f6fc4"},
                                                              {{0.71f, 0.95f, 0.3f}, "#5d8a0c"},
                                                              {{1.0f, 0.54f, 0.36f}, "#c9501f"},
                                                              {{0.78f, 0.62f, 1.0f}, "#7b53b5"},
                                                              {{0.82f, 0.84f, 0.8f}, "#6b705c"}}};

inline const VehicleColour& vehicle_colour(std::size_t vehicle) {
  return kVehicleColours[vehicle % kVehicleColours.size()];
}

/// Hexadecimal form, "#ffb80d", of a colour with components 0..1.
inline std::string hex_colour(const Eigen::Vector3f& rgb) {
  const auto byte = [](float share) { return static_cast<int>(std::lround(255.0f * share)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(rgb.x()), byte(rgb.y()), byte(rgb.z()));
}

}  // namespace vinerow::playback
