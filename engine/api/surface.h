#pragma once
/// Surface classes and materials.

#include <Eigen/Core>
#include <cstdint>
#include <string>

namespace vinerow {

/// Class of a surface. It decides how the surface looks, whether sensors see it, and the meaning of
/// a contact.
enum class SurfaceClass : std::uint8_t {
  kTerrain,   ///< ground: wheels roll on it
  kCanopy,    ///< leaves and shoots: counted as contact, does not push (foliage gives way)
  kPost,      ///< posts and end assemblies: rigid
  kTrunk,     ///< vine or tree stems: rigid
  kWire,      ///< trellis wires: rigid, included in distances, ignored by rays
  kObstacle,  ///< anything else that is rigid
  kVehicle,
};

/// Name for events and errors: "post".
const char* to_string(SurfaceClass surface);

/// What a camera's semantic picture calls a surface. The numbers are those in the picture; new ones
/// go to the end.
enum class Label : std::uint8_t {
  kSky = 0,
  kGround = 1,
  kLeaf = 2,
  kWood = 3,  ///< trunks, arms, canes and shoots
  kBunch = 4,
  kFruit = 5,
  kPost = 6,
  kWire = 7,
  kObstacle = 8,
  kVehicle = 9,
  kPerson = 10,
  kWeed = 11,
};
inline constexpr int kLabelCount = 12;

/// Name for datasets and messages: "leaf".
const char* to_string(Label label);
/// Label of what has no own: leaf for the canopy, wood for trunks.
Label label_of(SurfaceClass surface);

/// Appearance of a surface.
struct Material {
  std::string name;
  Eigen::Vector3f colour = {0.7f, 0.7f, 0.7f};  ///< linear RGB
  float roughness = 0.9f;
  std::string
      texture;  ///< absolute path of an image, or "" for none, or "builtin:<name>" (see render/)
  bool leaf_cards = false;  ///< alpha-tested, two-sided, lit as foliage
};

}  // namespace vinerow
