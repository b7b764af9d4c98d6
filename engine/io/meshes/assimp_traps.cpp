#include "engine/io/meshes/assimp_traps.h"

#include <stdexcept>
#include <string>

namespace Assimp {

/// Replaces assimp's own function of this name, which prints and aborts. ReadFile turns the
/// exception into its error text.
[[noreturn]] void aiAssertViolation(const char* condition, const char* /*file*/, int /*line*/) {
  throw std::runtime_error(std::string("its contents violate a rule of the format (") + condition +
                           ")");
}

}  // namespace Assimp
