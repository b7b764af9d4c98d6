#include "engine/api/mesh.h"

namespace vinerow {

const char* to_string(SurfaceClass surface) {
  constexpr const char* kNames[] = {"terrain", "canopy",   "post",   "trunk",
                                    "wire",    "obstacle", "vehicle"};
  return kNames[static_cast<int>(surface)];
}

const char* to_string(Label label) {
  constexpr const char* kNames[kLabelCount] = {"sky",      "ground",  "leaf",   "wood",
                                               "bunch",    "fruit",   "post",   "wire",
                                               "obstacle", "vehicle", "person", "weed"};
  return kNames[static_cast<int>(label)];
}

Label label_of(SurfaceClass surface) {
  constexpr Label kLabels[] = {Label::kGround, Label::kLeaf,     Label::kPost,   Label::kWood,
                               Label::kWire,   Label::kObstacle, Label::kVehicle};
  return kLabels[static_cast<int>(surface)];
}

}  // namespace vinerow
