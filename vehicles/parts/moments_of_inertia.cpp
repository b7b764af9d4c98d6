#include "vehicles/parts/moments_of_inertia.h"

#include <fmt/format.h>

namespace vinerow::vehicles {

std::string find_fault_in_moments(const std::string& name, const Eigen::Vector3d& principal_kgm2) {
  constexpr double kExcess = 0.01;
  const double largest = principal_kgm2.maxCoeff();
  if (2.0 * largest - principal_kgm2.sum() <= kExcess * largest) return "";
  return fmt::format(
      "{} = [{:.4g}, {:.4g}, {:.4g}] is not possible for a rigid body: one moment is larger than "
      "the sum of the other two",
      name, principal_kgm2.x(), principal_kgm2.y(), principal_kgm2.z());
}

}  // namespace vinerow::vehicles
