#pragma once
/// Zonotopes: {centre + G a : |a_i| <= 1}, closed under linear images. A gust
/// that acts through a matrix E, |d_i| <= 1, is the zonotope of generators E: a box around it would
/// lose the correlation of its components.

#include <Eigen/Core>

namespace vinerow::controllers {

class Zonotope {
 public:
  /// @param centre  n @param generators  n x k, k >= 0; finite
  /// @throws ConfigError if they do not fit or are not finite
  Zonotope(Eigen::VectorXd centre, Eigen::MatrixXd generators);
  /// Around the origin.
  explicit Zonotope(Eigen::MatrixXd generators);
  /// |x_i| <= half_i, half_i >= 0
  static Zonotope box(const Eigen::VectorXd& half);

  int dimension() const { return static_cast<int>(centre_.size()); }
  const Eigen::VectorXd& centre() const { return centre_; }
  const Eigen::MatrixXd& generators() const { return generators_; }

  /// max c'x = c'centre + sum |c'g_i|; exact. No heap.
  double support(const Eigen::VectorXd& c) const;
  double operator()(const Eigen::VectorXd& c) const { return support(c); }
  /// Half the extents along the axes: the smallest enclosing box is centre +- these.
  Eigen::VectorXd half_widths() const { return generators_.cwiseAbs().rowwise().sum(); }

  /// {M x : x in this}. @param M  any rows x dimension()
  Zonotope linear_image(const Eigen::MatrixXd& M) const;
  /// {factor x : x in this}
  Zonotope scaled(double factor) const { return {factor * centre_, factor * generators_}; }

 private:
  Eigen::VectorXd centre_;      // n
  Eigen::MatrixXd generators_;  // n x k
};

}  // namespace vinerow::controllers
