#include "engine/api/mesh.h"

namespace vinerow {

const char* to_string(SurfaceClass surface) {
  constexpr const char* kNames[] = {"terrain", "canopy",   "post",   "trunk",
                                    "wire",    "obstacle", "vehicle"};
  return kNames[static_cast<int>(surface)];
}

}  // namespace vinerow
