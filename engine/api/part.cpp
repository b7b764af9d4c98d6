#include "engine/api/part.h"

#include "engine/core/random.h"

namespace vinerow {

RandomStream PartContext::random(const std::string& component) const {
  return RandomStream(seed, vehicle, component.empty() ? part : part + "." + component);
}

}  // namespace vinerow
