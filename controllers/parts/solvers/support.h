#pragma once
/// The support function of a closed convex set S: h(c) = max c's over s in S. +infinity where S has
/// no end along c. Polytope, Zonotope, SeriesSupport and OuterMinimalSet are callable like this and
/// convert to it, as copies.

#include <Eigen/Core>
#include <functional>

namespace vinerow::controllers {

using Support = std::function<double(const Eigen::VectorXd& direction)>;

}  // namespace vinerow::controllers
