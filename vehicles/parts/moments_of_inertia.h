#pragma once

#include <Eigen/Core>
#include <string>

namespace vinerow::vehicles {

/// The fault of moments of inertia that no rigid body has. Since Ixx + Iyy = Izz + 2 m <z²>, no
/// principal moment exceeds the sum of the other two; a flat plate reaches it. Moments in files
/// have three digits or more, each wrong by up to 0.5 %: an excess of 1 % is accepted.
/// @param name            of the three numbers, for the sentence
/// @param principal_kgm2  about the principal axes, in any order; finite
/// @returns a sentence, "" if a rigid body can have these moments
std::string find_fault_in_moments(const std::string& name, const Eigen::Vector3d& principal_kgm2);

}  // namespace vinerow::vehicles
