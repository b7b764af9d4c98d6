#pragma once
/// What surfaces are and how they look.

#include <Eigen/Core>
#include <cstdint>
#include <string>

namespace vinerow {

/// What a surface is; decides how it looks, whether a sensor sees it, and what a contact with it
/// means.
enum class SurfaceClass : std::uint8_t {
  kTerrain,   ///< ground: wheels roll on it
  kCanopy,    ///< leaves and shoots: counted as contact, does not push (foliage gives way)
  kPost,      ///< posts and end assemblies: rigid
  kTrunk,     ///< vine or tree stems: rigid
  kWire,      ///< trellis wires: rigid, known to distances, missed by rays
  kObstacle,  ///< anything else that is rigid
  kVehicle,
};

/// "post": for events and errors.
const char* to_string(SurfaceClass surface);

/// How to draw a surface.
struct Material {
  std::string name;
  Eigen::Vector3f colour = {0.7f, 0.7f, 0.7f};  ///< linear RGB
  float roughness = 0.9f;
  std::string
      texture;  ///< absolute path of an image, or "" for none, or "builtin:<name>" (see render/)
  bool leaf_cards = false;  ///< alpha-tested, two-sided, lit as foliage
};

}  // namespace vinerow
