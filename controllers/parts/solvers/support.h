#pragma once
/// Support function of a closed convex set S: h(c) = max c's over s in S; +infinity if S is
/// unbounded along c. Polytope, Zonotope and SeriesSupport are callable like this and
/// convert to it, as copies.

#include <Eigen/Core>
#include <functional>

namespace vinerow::controllers {

using Support = std::function<double(const Eigen::VectorXd& direction)>;

}  // namespace vinerow::controllers
