#include "controllers/parts/solvers/zonotope.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "engine/core/error.h"

namespace vinerow::controllers {

Zonotope::Zonotope(Eigen::VectorXd centre, Eigen::MatrixXd generators)
    : centre_(std::move(centre)), generators_(std::move(generators)) {
  if (centre_.size() < 1 || generators_.rows() != centre_.size()) {
    throw ConfigError(fmt::format("a zonotope around a point of {} numbers has generators of {}",
                                  centre_.size(), generators_.rows()));
  }
  if (!centre_.allFinite() || !generators_.allFinite()) {
    throw ConfigError("a zonotope contains a number that is not finite");
  }
}

Zonotope::Zonotope(Eigen::MatrixXd generators)
    : Zonotope(Eigen::VectorXd::Zero(generators.rows()), generators) {}

Zonotope Zonotope::box(const Eigen::VectorXd& half) {
  for (Eigen::Index i = 0; i < half.size(); ++i) {
    if (half[i] < 0.0) {
      throw ConfigError(fmt::format("half width {} of a box is {}, must be >= 0", i, half[i]));
    }
  }
  return Zonotope(Eigen::MatrixXd(half.asDiagonal()));
}

double Zonotope::support(const Eigen::VectorXd& c) const {
  if (c.size() != centre_.size()) {
    throw ConfigError(fmt::format("a zonotope in {} dimensions does not match a direction in {}",
                                  dimension(), c.size()));
  }
  double sum = c.dot(centre_);
  for (Eigen::Index k = 0; k < generators_.cols(); ++k) sum += std::abs(generators_.col(k).dot(c));
  return sum;
}

Zonotope Zonotope::linear_image(const Eigen::MatrixXd& M) const {
  if (M.cols() != centre_.size()) {
    throw ConfigError(
        fmt::format("a zonotope in {} dimensions does not match a matrix of {} columns",
                    dimension(), M.cols()));
  }
  return {M * centre_, M * generators_};
}

}  // namespace vinerow::controllers
